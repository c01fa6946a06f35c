"""The FFT solver: nested grids, projected conjugate gradients, lagged shear and slopes."""
