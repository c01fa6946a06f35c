"""Influence integrals of a rectangular element, to rounding at any distance: the only home of these formulas.

``normal_integral`` is I[1/rho] (Love) and ``tangential_integral`` is I[s/rho^2] (Cerruti):
times ``(1-nu^2)/(pi E)`` and ``(1+nu)(1-2nu)/(2 pi E)`` they are the normal displacement of one elastic
half-space under unit normal pressure and under unit traction along x. Lengths are in m (any unit will do),
results in the same unit.

Relative error is at most 1e-13 (measured: see the cases ``kernels/*``) for offsets of 0 ... 1e6 elements
and aspect ratios 1e-3 ... 1e3. Closed forms serve up to three elements away (``love``, ``cerruti``),
quadrature over an exact inner integral beyond (``quadrature``), with the axis of the larger ``q = 2 offset /
edge`` as the outer one. Lengths are first divided by a power of two near the larger edge, which is exact, so
that 1e-12 and 1e12 are as good as 1.
"""

from __future__ import annotations

from refimpl.kernels.integrals import normal_integral, normal_table, tangential_integral, tangential_table

__all__ = ["normal_integral", "normal_table", "tangential_integral", "tangential_table"]
