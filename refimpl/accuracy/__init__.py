"""Error bars: the excess along the contact edge, limits of numbers over the grid, and their scatter."""
