"""The paper where it does not hold: a number against each place, and the same for its correction.

A case passes if the correction holds and the printed form misses by a multiple of its tolerance.
"""

from __future__ import annotations

import re

from appendix_a import errata as appendix
from verification.cases import Measured, family
from verification.reproduction import errata as body


def _judged(erratum: body.Erratum | appendix.Erratum, least: float, **more: str) -> Measured:
    """Return the corrected form's error; ArithmeticError if the printed one's is not ``least`` tolerances."""
    against, remains = erratum.evidence(), erratum.check()
    if not against > least * erratum.tolerance:
        raise ArithmeticError(f"the printed form misses by {against:.3g} only: no erratum")
    texts = {name: getattr(erratum, name) for name in ("equation", "printed", "corrected", "measure")}
    data = {**texts, **more, "printed_error": against, "corrected_error": remains}
    return Measured(value=remains, data=data, note=f"as printed: {against:.3g}")


@family(
    "erratum, tolerance",
    {f"errata/{one.slug}": (one, one.tolerance) for one in body.ERRATA},
    metric="at_most",
)
def in_the_body(erratum: body.Erratum) -> Measured:
    """Erratum to {erratum.equation}.

    Claim: {erratum.measure}: within the tolerance for the corrected form, {erratum.corrected}
    Source: paper, {erratum.equation}
    Tolerance: {erratum.tolerance_reason}
    """
    return _judged(erratum, 3)


@family(
    "erratum, tolerance",
    {
        "appendix-errata/" + "-".join(re.findall(r"\w+", one.equation.lower())): (one, one.tolerance)
        for one in appendix.ERRATA
    },
    metric="at_most",
)
def in_appendix_a(erratum: appendix.Erratum) -> Measured:
    """Erratum to ({erratum.equation}).

    Claim: {erratum.measure}: zero for the corrected form, {erratum.corrected}
    Source: paper Eq. ({erratum.equation}), derived anew
    Tolerance: {erratum.tolerance_reason}
    """
    return _judged(erratum, 100, kind=erratum.kind.value)
