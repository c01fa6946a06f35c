"""Elastic materials and what a pair of them contributes to the influence coefficients."""

from __future__ import annotations

import math
from dataclasses import dataclass

from refimpl.errors import LEAST, InputError, keep_doubles, require_number, require_size

RIGID = 1e100  # Pa; beside any other body's it is as good as infinite, and its square is a double


@dataclass(frozen=True)
class Material:
    """A linear elastic, isotropic material: Young's modulus ``E`` (Pa) and Poisson's ratio ``nu``.

    ``E = math.inf`` is a rigid body. ``hardness`` (Pa), if given, caps the contact pressures
    (`Scene.plastic`).

    Raises `InputError` unless ``E`` and ``hardness`` are positive and finite (``E`` may be infinite) and
    ``-1 < nu <= 0.5``.
    """

    E: float
    nu: float
    hardness: float | None = None

    def __post_init__(self) -> None:
        allowed = f"a positive Young's modulus in Pa, {LEAST} to {RIGID}, or infinity for a rigid body"
        E: object = self.E
        if not (isinstance(E, float) and math.isinf(E) and E > 0):
            require_number("E", self.E, allowed, at_least=LEAST, at_most=RIGID)
        require_number("nu", self.nu, "a Poisson's ratio in (-1, 0.5]", above=-1, at_most=0.5)
        if self.hardness is not None:
            require_size("hardness", self.hardness, "a positive, finite hardness in Pa")
        keep_doubles(self, "E", "nu", "hardness")

    @property
    def is_rigid(self) -> bool:
        """True where the modulus is infinite: both compliances are zero."""
        return math.isinf(self.E)

    @property
    def plane_strain_modulus(self) -> float:
        """``E / (1 - nu^2)`` (Pa)."""
        return self.E / (1 - self.nu**2)

    @property
    def normal_compliance(self) -> float:
        """Factor of ``I[1/rho]``: normal displacement per unit normal pressure (1/Pa), Boussinesq."""
        return (1 - self.nu**2) / (math.pi * self.E)

    @property
    def shear_compliance(self) -> float:
        """Factor of ``I[s/rho^2]``: normal displacement per unit tangential traction (1/Pa), Cerruti."""
        return (1 + self.nu) * (1 - 2 * self.nu) / (2 * math.pi * self.E)


@dataclass(frozen=True)
class Pair:
    """The two materials of a friction pair and their combined compliances.

    Normal compliances add. Shear compliances subtract, lower minus upper, because the two bodies
    feel opposite tractions: identical materials do not couple. One of them may be rigid; raises `InputError`
    for two.

    >>> steel = Material(E=200e9, nu=0.3)
    >>> Pair(lower=steel, upper=steel).shear_compliance
    0.0
    """

    lower: Material
    upper: Material

    def __post_init__(self) -> None:
        if self.lower.is_rigid and self.upper.is_rigid:
            raise InputError("upper.material.E", self.upper.E, "a finite modulus beside a rigid lower body")

    @property
    def normal_compliance(self) -> float:
        """Factor of ``I[1/rho]`` for the approach of both surfaces, ``1 / (pi E*)`` (1/Pa)."""
        return self.lower.normal_compliance + self.upper.normal_compliance

    @property
    def shear_compliance(self) -> float:
        """Factor of ``I[s/rho^2]`` for the approach of both surfaces, lower minus upper (1/Pa)."""
        return self.lower.shear_compliance - self.upper.shear_compliance

    @property
    def softer_hardness(self) -> float | None:
        """The smaller of the hardnesses given (Pa); None without any."""
        given = [h for h in (self.lower.hardness, self.upper.hardness) if h is not None]
        return min(given, default=None)

    @property
    def softer_sign(self) -> float:
        """1 if the lower body is softer, -1 if the upper one is, 0 if they are equally hard."""
        lower, upper = (math.inf if m.hardness is None else m.hardness for m in (self.lower, self.upper))
        return float(lower < upper) - float(upper < lower)

    @property
    def upper_share(self) -> float:
        """Share of the closing of the gap that the upper body takes."""
        return self.upper.normal_compliance / self.normal_compliance

    @property
    def coupling_ratio(self) -> float:
        """``c / a``: closing of the gap by unit shear over that by unit pressure."""
        return self.shear_compliance / self.normal_compliance

    @property
    def shear_ratio(self) -> float:
        """``(|c_lower| + |c_upper|) / a``: the ratio with both bodies' magnitudes."""
        return (abs(self.lower.shear_compliance) + abs(self.upper.shear_compliance)) / self.normal_compliance

    def tilts(self, shear: float) -> tuple[float, float]:
        """Return the slopes of both surfaces, each of its own body, right under a shear (Pa): ``pi c r``."""
        lower, upper = self.lower.shear_compliance, self.upper.shear_compliance
        return math.pi * lower * shear, math.pi * upper * shear

    @property
    def reduced_modulus(self) -> float:
        """``E* = 1 / sum((1 - nu^2) / E)`` (Pa)."""
        return 1 / (1 / self.lower.plane_strain_modulus + 1 / self.upper.plane_strain_modulus)
