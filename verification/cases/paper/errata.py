"""The paper's body where it does not hold: a number against each place, and the same for its correction."""

from __future__ import annotations

from verification.framework.case import Measured
from verification.framework.registry import case
from verification.reproduction.errata import ERRATA, Erratum


def _declare(erratum: Erratum) -> None:
    """A case: the correction holds, and the printed form misses by more than three times its tolerance."""

    @case(
        f"errata/{erratum.slug}",
        metric="at_most",
        tolerance=erratum.tolerance,
        title=f"Erratum to {erratum.equation}",
        claim=f"{erratum.measure}: within the tolerance for the corrected form, {erratum.corrected}",
        source=f"paper, {erratum.equation}",
        tolerance_reason=erratum.tolerance_reason,
    )
    def holds() -> Measured:
        against, remains = erratum.evidence(), erratum.check()
        if not against > 3 * erratum.tolerance:
            raise ArithmeticError(f"the printed form misses by {against:.3g} only: no erratum")
        data = {
            "equation": erratum.equation,
            "printed": erratum.printed,
            "corrected": erratum.corrected,
            "measure": erratum.measure,
            "printed_error": against,
            "corrected_error": remains,
        }
        return Measured(value=remains, data=data, note=f"as printed: {against:.3g}")


for _erratum in ERRATA:
    _declare(_erratum)
