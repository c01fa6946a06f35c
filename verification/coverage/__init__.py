"""Coverage of `accuracy=`: random scenes on nested grids, bars against errors."""
