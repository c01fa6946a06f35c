"""Grids refined until the error bar of a chosen number is as short as requested.

Two coarse grids open the sequence. Their error bar (`discretisation_error`) also predicts the bars of finer
grids, so the next grid is usually the last, and all earlier grids together cost a fraction of it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
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
_REST = 0.25  # share: of the parts that no grid reduces, for others; of the room left, for neglected terms
AIM = 1 + _REST  # bar over the parts that no grid reduces, at which a refinement that they end does end
_ITERATION_SHARE = 1e-3  # share of the accuracy that unfinished iterations may take


def check_accuracy(accuracy: float) -> None:
    """Raise `InputError` unless the accuracy is relative."""
    require_number("accuracy", accuracy, "a relative accuracy between 0 and 1", above=0, below=1)


def tolerance_for(accuracy: float) -> float:
    """Return the certificate tolerance for an accuracy: a small share of it, and at least 1e-8."""
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
    data: DataShares | None = None,
    restored: Callable[[], GridFeatures | None] = lambda: None,
) -> Refinement:
    """Solve grid after grid until the bar of ``quantity`` is within ``accuracy`` times its value.

    Numbers of elements along the longer side are ``slenderness`` times larger on a slender domain. Where
    parts that no grid reduces (`unfalling`) exceed the accuracy, or leave too little of it, grids are refined
    until the rest is a quarter of them, and no finer than the data allow. ``restored`` puts neglected terms
    back once they take more than a quarter of what those parts leave. A grid that ``features_at`` refuses by
    `InputError` is replaced by the next coarser one; one that is `Unfinished` ends the refinement, with a
    reason.
    """
    data = data or DataShares()
    results = [features_at(M * slenderness) for M in FIRST_GRIDS]
    remaining, refusal = [M * slenderness for M in grid_sizes], ""
    while results[-1].touching and (bound := relative_bound(results, quantity)) > accuracy:
        if math.isinf(_own_bound(results[-1], quantity)):
            return Refinement(tuple(results), _CUT_OFF)
        value, last = abs(results[-1].numbers[quantity]), longer_side(results[-1])
        stuck = unfalling(results, quantity, data)
        least = sum(stuck.values()) / value if value else 0.0
        if neglected_matter(results[-1], quantity, accuracy * value - least * value):
            again = restored()
            if again is not None:
                results[-1] = again
                continue
        hopeless = reason_unreachable(stuck, value, accuracy) if least > accuracy else ""
        remaining = [M for M in remaining if last < M]
        if not hopeless and remaining and not refusal:
            hopeless = too_fine(results, accuracy, quantity, least, max(remaining))
        aim = max(accuracy, AIM * least) if hopeless else accuracy
        useful = [M for M in remaining if not hopeless or data.finest >= M]
        if hopeless and (bound <= aim or not useful or too_fine(results, aim, quantity, 0.0, max(useful))):
            return Refinement(tuple(results), hopeless)
        if not useful:
            return Refinement(tuple(results), refusal or f"at most {last} elements a side are tried")
        M = next_grid(results, aim, quantity, useful, data)
        try:
            results.append(features_at(M))
        except InputError as refused:
            remaining, refusal = [size for size in remaining if size < M], str(refused)
        except Unfinished as ended:
            return Refinement(tuple(results), str(ended))
    return Refinement(tuple(results), "")


@dataclass(frozen=True)
class DataShares:
    """Uncertainty by the points of measured surfaces: ``left`` share of the contact area by elements along
    the longer side; ``finest`` elements that the data allow."""

    left: Callable[[int], float] = lambda M: 0.0
    finest: float = math.inf

    def factor(self, M: int, finer: float) -> float:
        """Return the part of the data on ``finer`` elements over that on M."""
        here = self.left(M)
        return self.left(round(finer)) / here if here > 0 else 1.0


def unfalling(results: Sequence[GridFeatures], quantity: str, data: DataShares) -> dict[str, float]:
    """Return the parts that no grid reduces: data and border as they will be left, and tau's active set
    where it did not fall on the last grid.
    """
    last = longer_side(results[-1])
    own = results[-1].parts.get(quantity, {})
    most = max(last, data.finest) if math.isfinite(data.finest) else last
    found = {"data": own.get("data", 0.0) * data.factor(last, most), "border": own.get("border", 0.0)}
    if len(results) > len(FIRST_GRIDS):
        coarse = results[-2].parts.get(quantity, {}).get("active set", 0.0)
        here = own.get("active set", 0.0)
        found["active set"] = here if here >= coarse else 0.0
    return found


def neglected_matter(result: GridFeatures, quantity: str, room: float) -> bool:
    """Return whether neglected terms take more than a quarter of the room that other parts leave."""
    return room > 0 and result.parts.get(quantity, {}).get("neglected", 0.0) > _REST * room


def reason_unreachable(stuck: Mapping[str, float], value: float, accuracy: float) -> str:
    """Return which parts exceed the accuracy on every grid, their sizes, and what would help."""
    if math.isinf(sum(stuck.values())):
        return _CUT_OFF
    sizes = {name: part / value for name, part in stuck.items() if part > 0}
    if not sum(sizes.values()) > accuracy:
        return ""
    largest = max(sizes, key=lambda name: sizes[name])
    shown = " and ".join(f"{_STUCK[name][0]} {size:.2g}" for name, size in sizes.items())
    return f"no grid reduces what is left open by {shown} of it; {_STUCK[largest][1]}"


_CUT_OFF = "the domain cuts the contact off: enlarge it"
_STUCK = {
    "data": ("what lies between the points of the data", "a map with a finer pitch would"),
    "border": ("the contact beyond the border", "a larger domain would"),
    "active set": ("tau's active set", "of the number, ask for a larger accuracy"),
}
"""Parts that no grid reduces: what leaves them open, and what would help."""


def longer_side(features: GridFeatures) -> int:
    """Return the number of elements along the longer side of a grid."""
    return max(features.grid.shape)


def next_grid(
    results: Sequence[GridFeatures],
    accuracy: float,
    quantity: str,
    grid_sizes: Sequence[int],
    data: DataShares | None = None,
) -> int:
    """Return the coarsest size whose predicted bar is short enough, within reach of the last grid."""
    fine = results[-1]
    within = estimates(results)[quantity].half_width < abs(fine.numbers[quantity])
    predictable = within and fine.waviness < _SHORT_WAVES
    ratio = MAX_REFINEMENT if predictable else MAX_BLIND_REFINEMENT
    reach = [size for size in grid_sizes if size <= ratio * longer_side(fine)] or grid_sizes[:1]
    return predicted_size(results, accuracy, quantity, reach, data) or reach[-1]


def predicted_size(
    results: Sequence[GridFeatures],
    accuracy: float,
    quantity: str,
    grid_sizes: Sequence[int],
    data: DataShares | None = None,
) -> int | None:
    """Return the coarsest size whose predicted bar is short enough; None if none is."""
    fine, data = results[-1], data or DataShares()
    found, estimate = fine.numbers[quantity], estimates(results)[quantity]
    parts, last, order = fine.parts.get(quantity, {}), longer_side(fine), _own_order(results, quantity)
    by_data, neglected = parts.get("data", 0.0), parts.get("neglected", 0.0)
    falling = _own_bound(fine, quantity) - by_data - neglected
    for M in grid_sizes:
        finer = last / M
        bound = estimate.predicted_bound(found, finer) + falling * finer**order + neglected
        if bound + by_data * data.factor(last, M) <= _MARGIN * accuracy * abs(found):
            return M
    return None


def _own_bound(features: GridFeatures, quantity: str) -> float:
    """Return what a grid's own solution leaves open of a number."""
    return sum(features.parts.get(quantity, {}).values())


_KNOWN = ("data", "neglected")  # parts on finer grids that are known


def _own_order(results: Sequence[GridFeatures], quantity: str) -> float:
    """Order at which that falls, from the last two grids, between 0 and 1; 1 for the first two grids."""
    coarse, fine = (
        sum(size for name, size in result.parts.get(quantity, {}).items() if name not in _KNOWN)
        for result in results[-2:]
    )
    if len(results) == len(FIRST_GRIDS) or not min(coarse, fine) > 0:
        return 1.0
    refinement = longer_side(results[-1]) / longer_side(results[-2])
    return min(max(math.log(coarse / fine) / math.log(refinement), 0.0), 1.0)


def too_fine(results: Sequence[GridFeatures], accuracy: float, quantity: str, stuck: float, most: int) -> str:
    """Return that an accuracy takes more than ``most`` elements a side, or nothing.

    Bars fall to the share ``stuck`` at order 2 at most. Nothing can be said before a third grid, and from
    bars beyond the number.
    """
    bound = relative_bound(results, quantity)
    if len(results) <= len(FIRST_GRIDS) or not 0 < bound < 1:
        return ""
    ratio = max(bound - stuck, 0.0) / (accuracy - stuck) if stuck < accuracy else math.inf
    needed = longer_side(results[-1]) * math.sqrt(ratio)
    said = f"at least {needed:.2g} elements a side, more than {most}"
    return f"by the bars so far it takes {said}" if needed > most else ""


def relative_bound(results: Sequence[GridFeatures], quantity: str) -> float:
    """Return the sum of the finest grid's parts over its value; infinite for a zero that is not exact."""
    value, bound = abs(results[-1].numbers[quantity]), sum(uncertainty(results)[quantity].values())
    if bound == 0:
        return 0.0
    return bound / value if value > 0 else float("inf")


def uncertainty(results: Sequence[GridFeatures]) -> Uncertainty:
    """Return all parts of the finest grid's numbers."""
    return merged(results[-1].parts, discretisation(results))
