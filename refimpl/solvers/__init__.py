"""Solvers on one grid: the production solver (FFT) and the paper's own scheme."""
