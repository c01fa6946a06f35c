"""The rounding of the paper's printed inputs, and what it leaves of the printed results."""

from __future__ import annotations

from verification.cases import Measured, case
from verification.reproduction.inputs import hertz_misfit, table

MESH, REALISATIONS = 128, 24


@case("reproduction/input-rounding", metric="at_most", tolerance=0.005, tier="full")
def rounding() -> Measured:
    """Sensitivities of Table 3 to the printed inputs.

    Claim: the solver's sensitivities of A and p_max to load and R are Hertz' exponents on smooth bodies
    Source: paper Tables 1 and 3, Fig. 6
    Tolerance: relative sensitivities by differences of +-3.5 to +-10 %: their cubic term is 1e-4; the
    corrected area is known to 0.05 % on this grid, over 7 % of R 0.5 % of a sensitivity

    Rough columns: paired surfaces on 128 x 128 elements. Effects on mu by Eq. (10).
    """
    data = table(MESH, REALISATIONS)
    u = {name: data[f"{name}: u of inputs"] for name in ("A", "mu", "p_max")}
    said = "; ".join(f"{name} {', '.join(f'{v:.1%}' for v in values)}" for name, values in u.items())
    note = f"by the printed inputs' last digits, smooth to rough: {said}"
    return Measured(value=hertz_misfit(data), data=data, note=note)
