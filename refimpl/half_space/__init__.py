"""Errors of the half-space on steep slopes: of influence coefficients and of whole contacts."""
