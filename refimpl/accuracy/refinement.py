"""Grids refined until the error bar of a chosen number is as short as requested.

Two coarse grids open the sequence. Their error bar (`discretisation_error`) also predicts the bars of finer
grids, so the next grid is usually the last, and all earlier grids together cost a fraction of it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from refimpl.accuracy.discretisation_error import discretisation, estimates
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.accuracy.iteration_error import Uncertainty, merged
from refimpl.errors import InputError, NotConverged, require_number

FIRST_GRIDS = (32, 64)  # elements along the longer side
GRID_SIZES = (*(quarter * 2**k for k in range(4, 10) for quarter in (5, 6, 7, 8)), 4096)
MAX_REFINEMENT = 8  # next grid over the last: predictions from two coarse grids are poor beyond
MAX_BLIND_REFINEMENT = 2  # ratio where the bar predicts nothing: longer than the number, or of short waves
_SHORT_WAVES = 0.5  # waviness from which bars fall faster than they predict, as waves are resolved
_MARGIN = 0.95  # share of the accuracy that a predicted bar may take
_ITERATION_SHARE = 1e-3  # share of the accuracy that unfinished iterations may take


def check_accuracy(accuracy: float) -> None:
    """Raise `InputError` unless the accuracy is relative."""
    require_number("accuracy", accuracy, "a relative accuracy between 0 and 1", above=0, below=1)


def tolerance_for(accuracy: float) -> float:
    """Return the certificate tolerance for an accuracy: a small share of it, and at least 1e-8.

    >>> tolerance_for(0.01)
    1e-05
    """
    return min(1e-5, max(1e-8, _ITERATION_SHARE * accuracy))


class Unfinished(NotConverged):
    """A grid on which the solve does not converge."""


@dataclass(frozen=True)
class Refinement:
    """The grids solved, coarse to fine; ``refusal`` is the reason why no finer one was solved, or empty."""

    results: tuple[GridFeatures, ...]
    refusal: str


def refine_until(
    features_at: Callable[[int], GridFeatures],
    accuracy: float,
    quantity: str,
    grid_sizes: Iterable[int] = GRID_SIZES,
    *,
    slenderness: int = 1,
    finest_by_data: float = math.inf,
) -> Refinement:
    """Solve grid after grid until the bar of ``quantity`` is within ``accuracy`` times its value.

    On a slender domain all numbers of elements along the longer side are ``slenderness`` times larger.

    An accuracy that even the finest size cannot give ends the refinement. A grid that ``features_at`` refuses
    by `InputError` (memory, limits) is replaced by the next coarser one, as long as that is finer than the
    last: a demand that cannot be met within limits ends on the finest grid within them, as looser ones do.
    One that is `Unfinished` ends the refinement on the grid before. The part that tau's active set leaves
    open need not fall on finer grids: where it has not fallen and exceeds the accuracy, the refinement ends.
    Where the data leave more open than the accuracy, no grid is finer than ``finest_by_data`` elements along
    the longer side.
    """
    results = [features_at(M * slenderness) for M in FIRST_GRIDS]
    remaining, refusal = [M * slenderness for M in grid_sizes], ""
    while results[-1].touching and relative_bound(results, quantity) > accuracy:
        if reason := reason_unreachable(results, accuracy, quantity):
            return Refinement(tuple(results), reason)
        last = longer_side(results[-1])
        remaining = [M for M in remaining if last < M]
        data = REMAINING_PARTS["data"] if exceeds("data", results[-1], accuracy, quantity) else ""
        useful = [M for M in remaining if not data or finest_by_data >= M]
        if useful and not refusal and (needed := least_size(results, accuracy, quantity)) > max(useful):
            size = f"at least {needed:.2g} elements a side, more than {max(useful)}"
            return Refinement(tuple(results), data or f"by the bars so far it takes {size}")
        if not useful:
            return Refinement(tuple(results), data or refusal or f"at most {last} elements a side are tried")
        M = next_grid(results, accuracy, quantity, useful)
        try:
            results.append(features_at(M))
        except InputError as refused:
            remaining, refusal = [size for size in remaining if size < M], str(refused)
        except Unfinished as ended:
            return Refinement(tuple(results), str(ended))
    return Refinement(tuple(results), "")


def reason_unreachable(results: Sequence[GridFeatures], accuracy: float, quantity: str) -> str:
    """Return why no finer grid can reach an accuracy; empty where none is known not to."""
    if math.isinf(_own_bound(results[-1], quantity)):
        return "the domain cuts the contact off: enlarge it"
    reasons = (
        text for part, text in REMAINING_PARTS.items() if no_longer_falls(part, results, accuracy, quantity)
    )
    return next(reasons, "")


def longer_side(features: GridFeatures) -> int:
    """Return the number of elements along the longer side of a grid."""
    return max(features.grid.shape)


def next_grid(
    results: Sequence[GridFeatures], accuracy: float, quantity: str, grid_sizes: Sequence[int]
) -> int:
    """Return the coarsest size whose predicted bar is short enough, within reach of the last grid."""
    fine = results[-1]
    within = estimates(results)[quantity].half_width < abs(fine.numbers[quantity])
    predictable = within and fine.waviness < _SHORT_WAVES
    ratio = MAX_REFINEMENT if predictable else MAX_BLIND_REFINEMENT
    reach = [size for size in grid_sizes if size <= ratio * longer_side(fine)] or grid_sizes[:1]
    return predicted_size(results, accuracy, quantity, reach) or reach[-1]


def predicted_size(
    results: Sequence[GridFeatures], accuracy: float, quantity: str, grid_sizes: Sequence[int]
) -> int | None:
    """Return the coarsest size whose predicted bar is short enough; None if none is."""
    fine = results[-1]
    found, estimate = fine.numbers[quantity], estimates(results)[quantity]
    own, order = _own_bound(fine, quantity), _own_order(results, quantity)
    for M in grid_sizes:
        finer = longer_side(fine) / M
        bound = estimate.predicted_bound(found, finer) + own * finer**order
        if bound <= _MARGIN * accuracy * abs(found):
            return M
    return None


def _own_bound(features: GridFeatures, quantity: str) -> float:
    """What a grid's own solution leaves open of a number."""
    return sum(features.parts.get(quantity, {}).values())


def _own_order(results: Sequence[GridFeatures], quantity: str) -> float:
    """Order at which that falls, from the last two grids, between 0 and 1; 1 for the first two grids."""
    coarse, fine = (_own_bound(result, quantity) for result in results[-2:])
    if len(results) == len(FIRST_GRIDS) or not min(coarse, fine) > 0:
        return 1.0
    refinement = longer_side(results[-1]) / longer_side(results[-2])
    return min(max(math.log(coarse / fine) / math.log(refinement), 0.0), 1.0)


REMAINING_PARTS = {
    "active set": "tau's active set leaves more than that open, and no less on finer grids",
    "data": "what lies between the points of the data leaves more than that open, and no less on finer grids",
}
"""Parts that need not fall on finer grids, and what is said where they do not."""


def no_longer_falls(part: str, results: Sequence[GridFeatures], accuracy: float, quantity: str) -> bool:
    """Return whether a part leaves more than the accuracy open, no less than on the grid before, and most of
    all that is open."""
    if len(results) == len(FIRST_GRIDS):
        return False
    coarse, fine = (result.parts.get(quantity, {}).get(part, 0.0) for result in results[-2:])
    most = 2 * fine >= sum(uncertainty(results)[quantity].values())
    return fine >= coarse and most and exceeds(part, results[-1], accuracy, quantity)


def exceeds(part: str, result: GridFeatures, accuracy: float, quantity: str) -> bool:
    """Return whether a part alone leaves more than the accuracy open."""
    return result.parts.get(quantity, {}).get(part, 0.0) > accuracy * abs(result.numbers[quantity])


def least_size(results: Sequence[GridFeatures], accuracy: float, quantity: str) -> float:
    """Return the elements a side that an accuracy takes at least: bars fall at order 2 at most.

    The size of the last grid where that cannot be said: before a third grid, or from bars beyond the number.
    """
    size, bound = longer_side(results[-1]), relative_bound(results, quantity)
    if len(results) <= len(FIRST_GRIDS) or not 0 < bound < 1:
        return size
    return size * math.sqrt(bound / accuracy)


def relative_bound(results: Sequence[GridFeatures], quantity: str) -> float:
    """Return the sum of the finest grid's parts over its value; infinite for a zero that is not exact."""
    value, bound = abs(results[-1].numbers[quantity]), sum(uncertainty(results)[quantity].values())
    if bound == 0:
        return 0.0
    return bound / value if value > 0 else float("inf")


def uncertainty(results: Sequence[GridFeatures]) -> Uncertainty:
    """Return all parts of the finest grid's numbers."""
    return merged(results[-1].parts, discretisation(results))
