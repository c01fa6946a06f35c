"""Constants of the error bars and of the edge rule: ``python -m verification.coverage.fit``.

Every constant is fitted by likelihood to the errors of building scenes (`building`), stored as features, so
that a fit takes a minute: ``--solve N`` first solves the scenes of N seeds of each class. An error is that of
a grid's number from the reference's, and its parts of a grid less the reference's parts, so that the
reference needs no correction of its own; of punches with a rounded rim the number is known. ``--judge`` draws
fresh seeds and prints how the bars of the constants in `refimpl` cover their errors.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from refimpl.accuracy.contact_edge import GAPS, KINDS, PRESSURES
from refimpl.accuracy.discretisation_error import approach_sizes, rest_sizes
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.accuracy.scatter import area_counts, edge_scatter, plastic_sizes, rim_count, straight_share
from refimpl.grid import Array
from verification.coverage import classes
from verification.coverage.building import Solved, merged, pack, solve_all, solved, unpacked
from verification.coverage.class_scenes import CLASSES
from verification.coverage.likelihood import Fitted, fit
from verification.framework.case import jsonable
from verification.output.provenance import provenance
from verification.output.result_files import write_result
from verification.output.text_table import columns

CONSTANTS = Path("refimpl/data/error_bars.json")
FEATURES = Path("reports/results/error_bar_features.json.gz")  # building scenes
BUILT, JUDGED = Path("build/error_bars_built.jsonl"), Path("build/error_bars_judged.jsonl")  # runs, resumable
JUDGEMENT = Path("reports/results/coverage_corrected.json.gz")
BUILDING_SEED, JUDGING_SEED = 5_000_000, 10_000_000
# Seeds from 6 to 9 million were looked at while rules were built
EARLIER = "set before this program, by scenes of `verification.coverage.scenes`; no building scene gives it"
FREEDOMS = 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 10.0
_LEAST_WAVES = 0.005  # share of the rms gradient that a grid misses, from which its area is no edge's

_AREA = "contact_area_corrected"

Row = tuple[float, Array, Array]  # error, sizes of the mean's parts, squared sizes of the scatter's
Constant = dict[str, Any]
Sample = Callable[[GridFeatures, GridFeatures, Solved], Row | None]


def _area_row(grid: GridFeatures, reference: GridFeatures, one: Solved) -> Row | None:
    """Return the excess of the counted area, in elements; none where short waves or the hardness decide."""
    dA, ratio = grid.grid.element_area, reference.grid.element_area / grid.grid.element_area
    if grid.missed_share > _LEAST_WAVES or grid.yields:
        return None
    terms, counts, area = grid.excess_terms, area_counts(grid), one.exact.get("contact_area")
    if area is None:
        terms = terms - ratio * reference.excess_terms
        counts, area = counts + ratio**2 * area_counts(reference), reference.numbers["contact_area"]
    return (grid.numbers["contact_area"] - area) / dA, terms, counts


def _rest_row(grid: GridFeatures, reference: GridFeatures, one: Solved) -> Row | None:
    off = _rest(grid) - _rest(reference)
    return off, np.zeros(0), _squares(rest_sizes, grid, reference)


def _transverse_row(grid: GridFeatures, reference: GridFeatures, one: Solved) -> Row | None:
    if grid.rms_slope == 0:
        return None
    squares = _squares(rest_sizes, grid, reference)
    squares[0] = sum(float(edge_scatter([features])[0]) ** 2 for features in (grid, reference))
    load = grid.numbers["normal_force"]
    return (grid.numbers["binormal_force"] - reference.numbers["binormal_force"]) / load, np.zeros(0), squares


def _peak_row(grid: GridFeatures, reference: GridFeatures, one: Solved) -> Row | None:
    """Return the relative error of the parabola's peak; none at the hardness or without bound."""
    if grid.yields or not (grid.peak.smooth and reference.peak.smooth):
        return None
    height = reference.peak.height
    sizes = np.array(
        [
            [f.peak.widened(f.peak.curvature_drop), f.peak.height * straight_share(f) ** 2]
            for f in (grid, reference)
        ]
    )
    if not np.isfinite(sizes).all():
        return None
    drop = grid.peak.curvature_drop - reference.peak.curvature_drop
    off = (grid.peak.height - height) / height
    return off, np.array([drop / height]), ((sizes / height) ** 2).sum(axis=0)


def _approach_row(grid: GridFeatures, reference: GridFeatures, one: Solved) -> Row | None:
    depth = reference.depth
    squares = _squares(approach_sizes, grid, reference) / depth**2
    if not np.isfinite(squares).all():
        return None
    near, far = (f.numbers["approach"] + f.first_contact.height for f in (grid, reference))
    return (near - far) / depth, np.zeros(0), squares


def _plastic_row(grid: GridFeatures, reference: GridFeatures, one: Solved) -> Row | None:
    if grid.unfilled is None or not grid.yields:
        return None
    dA = grid.grid.element_area
    lack = -np.array([grid.plastic_edge - reference.plastic_edge]) / dA
    squares = (plastic_sizes(grid) ** 2 + plastic_sizes(reference) ** 2) / dA**2
    return (grid.numbers["plastic_area"] - reference.numbers["plastic_area"]) / dA, lack, squares


def _rest(features: GridFeatures) -> float:
    return features.numbers["friction_coefficient"] - features.dmu_dA * features.numbers["contact_area"]


def _squares(
    sizes: Callable[[Sequence[GridFeatures]], Array], grid: GridFeatures, reference: GridFeatures
) -> Array:
    return sizes([grid])[:, 0] ** 2 + sizes([reference])[:, 0] ** 2


def rows_of(sample: Sample, scenes: Iterable[Solved]) -> tuple[Array, Array, Array]:
    """Return errors (n,), sizes of the mean's parts (n, k) and squared sizes of the scatter's (n, m)."""
    each = ((grid, one.grids[-1], one) for one in scenes for grid in one.grids[:-1])
    rows = [row for three in each if (row := sample(*three)) is not None]
    errors, means, squares = (np.array(column) for column in zip(*rows, strict=True))
    return errors, means, squares


def smoothness() -> Array:
    """Return the precision of the edge rule's prior: neighbours in the table differ by 0.15 of an element,
    both kinds of faces by 0.15, and each is within 0.3."""
    count = int(np.prod(KINDS))
    index = np.arange(count).reshape(KINDS)
    prior = np.eye(count + 2) / 0.3**2
    for axis in range(3):
        for a, b in zip(np.delete(index, -1, axis).ravel(), np.delete(index, 0, axis).ravel(), strict=True):
            prior[[a, b, a, b], [a, b, b, a]] += np.array([1, 1, -1, -1]) / 0.15**2
    return prior


def area_constants(scenes: Sequence[Solved]) -> dict[str, Constant]:
    """Return the edge rule and the scatter of an area; all faces' excess together is a part of it."""
    errors, means, squares = rows_of(_area_row, scenes)
    first = fit(errors, means, squares, freedoms=[4.0], prior=smoothness(), start=0.2)
    excess = (means @ first.mean)[:, None] ** 2
    found = fit(errors, means, np.hstack([squares, excess]), freedoms=FREEDOMS, prior=smoothness(), start=0.1)
    normal = scipy.special.stdtrit(found.freedom, 0.975) / scipy.special.ndtri(0.975)  # at the same 95 %
    count = int(np.prod(KINDS))
    faces, face_errors = (values[:count].reshape(KINDS) for values in (found.mean, found.mean_error))
    return {
        "face_excess": constant(faces, face_errors, found),
        "straight_excess": constant(found.mean[count], found.mean_error[count], found),
        "border_excess": constant(found.mean[count + 1], found.mean_error[count + 1], found),
        "area_scatter": constant(found.scale[:-1], found.scale_error[:-1], found),
        "excess_spread": constant(normal * found.scale[-1], normal * found.scale_error[-1], found),
        "area_freedom": constant(found.freedom, None, found),
    }


def rim_constants(scenes: Iterable[Solved], edge: Mapping[str, Constant]) -> dict[str, Constant]:
    """Return the scatter of faces before elements at the hardness, beside that of every edge."""
    scatter, spread, freedom = (
        edge[name]["value"] for name in ("area_scatter", "excess_spread", "area_freedom")
    )

    def sizes(features: GridFeatures, dA: float) -> Array:
        """Return the squares in elements of dA: of the rim, and all else."""
        ratio = features.grid.element_area / dA
        own = np.square(scatter) @ area_counts(features) * ratio**2 + (spread * features.excess / dA) ** 2
        return np.array([rim_count(features) * ratio**2, own])

    rows = []
    for one in scenes:
        reference = one.grids[-1]
        for grid in one.grids[:-1]:
            if grid.rim_faces and grid.missed_share <= _LEAST_WAVES:
                dA = grid.grid.element_area
                off = (grid.corrected[_AREA] - reference.corrected[_AREA]) / dA
                rows.append((off, *(sizes(grid, dA) + sizes(reference, dA))))
    errors, rim, known = np.array(rows).T
    found = fit(errors, np.zeros((len(rows), 0)), rim[:, None], freedoms=[freedom], known=known, start=0.1)
    return {"rim_scatter": constant(found.scale[0], found.scale_error[0], found)}


SAMPLES: dict[str, Sample] = {
    "bulk": _rest_row,
    "binormal": _transverse_row,
    "peak": _peak_row,
    "approach": _approach_row,
    "plastic": _plastic_row,
}
"""Numbers whose scatter is fitted, by the name of their constants."""
MEANS = {"peak": "peak_bias", "plastic": "plastic_lack"}
"""Constants of those whose errors have a mean."""


def scatter_constants(name: str, scenes: Sequence[Solved]) -> dict[str, Constant]:
    """Return the constants of one of `SAMPLES`: scatter of each part, freedom, and the mean's factor."""
    found = fit(*rows_of(SAMPLES[name], scenes), freedoms=FREEDOMS, start=0.05)
    mean = {MEANS[name]: constant(found.mean[0], found.mean_error[0], found)} if name in MEANS else {}
    return {
        f"{name}_scatter": constant(found.scale, found.scale_error, found),
        f"{name}_freedom": constant(found.freedom, None, found),
        **mean,
    }


def constant(value: float | Array, error: float | Array | None, found: Fitted) -> Constant:
    """Return a constant with its standard error, and the likelihood that it is of."""
    plain = [None if array is None else _rounded(np.asarray(array)) for array in (value, error)]
    return {
        "value": plain[0],
        "standard_error": plain[1],
        "log_likelihood": round(found.likelihood, 1),
        "errors": found.samples,
    }


def _rounded(values: Array) -> Any:
    return np.vectorize(lambda x: float(f"{x:.3g}"))(values).tolist()


def fitted(scenes: Sequence[Solved]) -> dict[str, Constant]:
    """Return all constants that the building scenes give, by name."""
    found = area_constants(scenes)
    found |= rim_constants(scenes, found)
    for name in SAMPLES:
        found |= scatter_constants(name, scenes)
    return found


def document(scenes: Sequence[Solved], before: Mapping[str, Constant]) -> dict[str, Any]:
    """Return the file of constants: those fitted, and of ``before`` those that no building scene gives."""
    found = fitted(scenes)
    kept = {
        name: {"value": one["value"], "source": one.get("source", EARLIER)} for name, one in before.items()
    }
    seeds = sorted({one.seed for one in scenes})
    return {
        "provenance": provenance(),
        "seeds": [seeds[0], seeds[-1]],
        "scenes": len(scenes),
        "classes": list(dict.fromkeys(one.kind for one in scenes)),
        "knots": {"pressures": PRESSURES.tolist(), "gaps": GAPS.tolist()},
        "constants": {name: found.get(name, kept.get(name)) for name in {**before, **found}},
    }


def main(arguments: Sequence[str] | None = None) -> None:
    """Solve what is requested, fit and write the constants, or judge them."""
    parser = argparse.ArgumentParser(prog="python -m verification.coverage.fit", description=__doc__)
    parser.add_argument("--solve", type=int, default=0, metavar="N", help="first solve N seeds of each class")
    parser.add_argument("--first", type=int, help="first seed")
    parser.add_argument("--kind", choices=tuple(CLASSES), action="append", help="only scenes of a class")
    parser.add_argument("--judge", action="store_true", help="judge fresh scenes, print the table")
    parser.add_argument("--lines", type=Path, help="solved scenes, a JSON line each, of a run to be gone on")
    chosen = parser.parse_args(arguments)
    lines = chosen.lines or (JUDGED if chosen.judge else BUILT)
    if chosen.solve:
        first = chosen.first or (JUDGING_SEED if chosen.judge else BUILDING_SEED)
        solve_all(lines, range(first, first + chosen.solve), chosen.kind or tuple(CLASSES))
    if chosen.judge:
        judged = {"provenance": provenance(), **classes.document(solved(lines))}
        write_result(jsonable(judged), JUDGEMENT)
        print(columns(classes.lines(judged["table"]), indent=""))
        return
    if chosen.solve or chosen.lines:
        stored = [one for one in unpacked(FEATURES) if one.kind in CLASSES]
        pack(merged(stored, solved(lines)), FEATURES)
    scenes = unpacked(FEATURES)
    written = document(scenes, json.loads(CONSTANTS.read_text(encoding="utf-8"))["constants"])
    CONSTANTS.write_text(json.dumps(jsonable(written), indent=1) + "\n", encoding="utf-8")
    print(columns(summary(written["constants"]), indent=""))


def summary(constants: Mapping[str, Constant]) -> list[list[str]]:
    """Return the lines of the printed table of constants."""
    lines = [["constant", "value", "standard error", "log-likelihood", "errors"]]
    for name, one in constants.items():
        values, errors = np.ravel(one["value"]), np.ravel(one.get("standard_error") or [])
        shown = [" ".join(f"{x:.3g}" for x in numbers[:8]) for numbers in (values, errors)]
        lines.append([name, *shown, str(one.get("log_likelihood", "")), str(one.get("errors", ""))])
    return lines


if __name__ == "__main__":
    main()
