"""Finite elements on rough boundaries: the error of flat influence coefficients (2-D, axisymmetric)."""

from appendix_a.fem.result import WavyResult
from appendix_a.fem.sinusoid import fem_json, sinusoid

__all__ = ["WavyResult", "fem_json", "sinusoid"]
