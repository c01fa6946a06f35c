"""Faults in one part of `appendix_a` each: the checks of the paper's appendix must see them."""

from __future__ import annotations

from appendix_a import leading_order, wedge_tip
from appendix_a.fem import elasticity
from appendix_a.strip import field, perturbation, superposition
from appendix_a.wedge import fast, transform
from verification.matrix.patches import LocalFault, everywhere, wrapped

_flat, _flamant = field.flat_displacement, superposition.flamant


def _tilted_lame(nu: float) -> tuple[float, float]:
    """Plane stress."""
    return nu / (1 - nu**2), 0.5 / (1 + nu)


IN_APPENDIX: dict[str, LocalFault] = {
    "wedge-remainder": (
        "wedge remainder R_T with the other sign",
        lambda: wrapped(transform.remainders, lambda both: (both[0], -both[1])),
    ),
    "wedge-half-plane": (
        "the wedge's half-plane part times 1 + 1e-9",
        lambda: wrapped(fast.half_plane, lambda both: tuple((1 + 1e-9) * part for part in both)),
    ),
    "wedge-base": (
        "base tractions of the wedge tip times 1 + 1e-6",
        lambda: wrapped(wedge_tip.base_tractions, lambda both: tuple((1 + 1e-6) * part for part in both)),
    ),
    "strip-shear": (
        "tau_xy of (A1) with the other sign",
        lambda: wrapped(field.stresses, lambda s: (s[0], s[1], -s[2])),
    ),
    "strip-plane-stress": (
        "a flat boundary's displacement in plane stress",
        lambda: everywhere(field.flat_displacement, lambda x, nu: _flat(x, 0.0)),
    ),
    "strip-first-order": (
        "the first-order change with the other sign",
        lambda: wrapped(perturbation.first_order, lambda both: (2 * both[1] - both[0], both[1])),
    ),
    "strip-superposition": (
        "Flamant's tangential part left out",
        lambda: everywhere(
            superposition.flamant, lambda x, s, along, down, nu: _flamant(x, s, 0 * along, down, nu)
        ),
    ),
    "leading-order": (
        "the coupling of leading order halved",
        lambda: wrapped(leading_order.coupling, lambda value: 0.5 * value),
    ),
    "fem-plane-stress": (
        "finite elements in plane stress",
        lambda: everywhere(elasticity.lame, _tilted_lame),
    ),
}
