"""`solve` and its options: the plan, grids from coarse to fine, the accuracy that is requested."""
