"""Cases, their registry, runner and results."""
