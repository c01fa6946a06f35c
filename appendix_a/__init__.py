"""Appendix A of the paper: errors of flat influence coefficients on rough boundaries."""
