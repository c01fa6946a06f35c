"""What surfaces or refinement have to say about a solution, beside the limits of `refimpl.solution.limits`."""

from __future__ import annotations


class Remark(str):
    """A text that is read like a `refimpl.solution.limits.Caution`, of the one ``limit`` "remark", without numbers.

    >>> Remark("3 points filled in").limit
    'remark'
    """

    limit = "remark"
    number = None
    allowed = None
