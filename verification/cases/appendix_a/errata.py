"""The printed equations of Appendix A that fail: a number against each, and the same for its correction."""

from __future__ import annotations

import re

from appendix_a.errata import ERRATA, Erratum
from verification.framework.case import Measured
from verification.framework.registry import case


def declare(erratum: Erratum, slug: str) -> None:
    """A case: the correction holds, and the printed form misses by a hundred times its tolerance at least."""

    @case(
        f"appendix-errata/{slug}",
        metric="at_most",
        tolerance=erratum.tolerance,
        title=f"Erratum to ({erratum.equation})",
        claim=f"{erratum.measure}: zero for the corrected form, {erratum.corrected}",
        source=f"paper Eq. ({erratum.equation}), derived anew",
        tolerance_reason=erratum.tolerance_reason,
    )
    def holds() -> Measured:
        against, remains = erratum.evidence(), erratum.check()
        if not against > 100 * erratum.tolerance:
            raise ArithmeticError(f"the printed form misses by {against:.3g} only: no erratum")
        data = {
            "equation": erratum.equation,
            "kind": erratum.kind.value,
            "printed": erratum.printed,
            "corrected": erratum.corrected,
            "measure": erratum.measure,
            "printed_error": against,
            "corrected_error": remains,
        }
        return Measured(value=remains, data=data, note=f"as printed: {against:.3g}")


for _erratum in ERRATA:
    declare(_erratum, "-".join(re.findall(r"\w+", _erratum.equation.lower())))
