"""Notes of surfaces and of the refinement about a solution, beside the model limits of `limits`."""

from __future__ import annotations


class Remark(str):
    """A text with the fields of a `Caution`: ``limit`` is "remark", ``number`` and ``allowed`` are None.

    >>> Remark("3 points filled in").limit
    'remark'
    """

    limit = "remark"
    number = None
    allowed = None
