"""How often `accuracy=` keeps its word: random scenes on nested grids, bars against errors."""
