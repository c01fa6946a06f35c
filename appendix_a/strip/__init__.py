"""Strip of pressure on a wavy boundary by perturbing the half-plane (paper Appendix A, (A1)-(A3))."""

from appendix_a.strip.perturbation import first_order
from appendix_a.strip.superposition import Theta, printed

__all__ = ["Theta", "first_order", "printed"]
