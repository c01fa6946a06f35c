"""Programs that interpreters of published codes run, apart from modules with the names of those codes."""
