"""What a solver asks of an influence operator: one ``normal`` and one ``shear`` product."""

from __future__ import annotations

from typing import Protocol

from refimpl.grid import Array, Grid


class Influence(Protocol):
    """The convolutions of Eq. (7) without their compliances.

    ``normal(p)`` is ``sum I[1/rho] p`` and ``shear(q)`` is ``sum I[s/rho^2] q`` with ``s`` along the
    sliding direction; ``shear_across(q)`` has ``s`` along the direction 90 degrees anticlockwise of
    it. Arguments and results have shape ``(M, M)``; tractions in Pa give results in Pa m.
    """

    grid: Grid

    def normal(self, pressure: Array) -> Array:
        """``I[1/rho]`` applied to a pressure."""
        ...

    def shear(self, traction: Array) -> Array:
        """``I[s/rho^2]`` applied to a traction along the sliding direction."""
        ...

    def shear_across(self, traction: Array) -> Array:
        """``I[t/rho^2]`` applied to a traction across the sliding direction."""
        ...
