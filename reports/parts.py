"""The chapter on the paper's figures and tables: its parts, with claims, numbers and figures of each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

from reports.agreement import Number
from reports.claims import Judged
from reports.results import Case


@dataclass(frozen=True)
class Part:
    """A part of the paper: its name as in `paper.toml`, the scene that is computed, and the cases whose
    figures are shown; of several alike the first.
    """

    name: str
    setting: str
    figures: tuple[str, ...] = ()


PARTS = (
    Part(
        "Table 1",
        "The smooth ball on the smooth flat, 70 N, without friction, beside Hertz.",
        ("hertz/peak-pressure", "hertz/peak-order", "hertz/radius-corrected"),
    ),
    Part(
        "Fig. 3",
        'The paper\'s scheme (method "paper") as in section 5: three nested iterations and a residual '
        "correction.",
        ("paper/periodicity-error", "paper/periodicity-extent", "paper/convergence"),
    ),
    Part(
        "Fig. 4",
        "Surfaces of Eq. (9): 75 realisations on 512 x 512 elements of the nominal square of 1.61 mm.",
        ("reproduction/fig4-correlation*",),
    ),
    Part("Fig. 5", "The smooth sliding ball, 70 N, on 512 x 512 elements.", ("reproduction/fig5-edge*",)),
    Part(
        "Fig. 6",
        "Frictionless contact with all roughness on the flat and without slopes, 75 realisations on 256 x "
        "256 elements; (d) one realisation. Greenwood and Tripp's model has the statistics of Eq. (9); the "
        "textbook's curve has mu = 4. The printed curves are not known to us.",
        ("reproduction/fig6[abc]*", "reproduction/fig6d"),
    ),
    Part("Fig. 7", "One realisation, sigma_e = 0.511 um, on 512 x 512 elements.", ("reproduction/fig7*",)),
    Part(
        "Fig. 8",
        "25 realisations at each of twelve roughnesses and three loads on 256 x 256 elements. Table 3 has "
        "512 x 512 elements and 75 realisations: their means of one scene differ by the mesh.",
        ("reproduction/fig8-*",),
    ),
    Part(
        "Section 8: scatter",
        "75 realisations; print does not state the roughness.",
        ("reproduction/section8-scatter*", "reproduction/section8-beta0*", "reproduction/steady-sliding*"),
    ),
    Part(
        "Fig. 9", "One realisation, 12 directions, 17 offsets, 256 x 256 elements.", ("reproduction/fig9*",)
    ),
    Part(
        "Fig. 10", "Six realisations, 24 directions; the curves are of the first.", ("reproduction/fig10-*",)
    ),
    Part("Fig. 11", "75 realisations on 256 x 256 elements, flat of 1.68 um.", ("reproduction/fig11-*",)),
    Part(
        "Table 2",
        "The scene of the printed table, from its reference [37], is not known to us: points and hours "
        "cannot be compared, ratios and growth can.",
    ),
    Part(
        "Table 3",
        "75 realisations of each rough column on each mesh, as printed.",
        ("reproduction/table3-mu*", "reproduction/table3-area*", "reproduction/table3-peak*"),
    ),
)


@dataclass(frozen=True)
class Shown:
    """A part with what the evidence holds of it."""

    part: Part
    claims: Sequence[Judged]
    numbers: Sequence[Number]
    cases: Sequence[Case]


def shown(claims: Sequence[Judged], numbers: Sequence[Number], cases: Sequence[Case]) -> list[Shown]:
    """Every part of which anything is known; a long case that passed replaces the quick one of its name."""
    long = {case["id"] for case in cases if case["id"].endswith("-full") and case["status"] == "pass"}
    known = [case for case in cases if f"{case['id']}-full" not in long]
    found = []
    for part in PARTS:
        drawn = [case for pattern in part.figures for case in known if fnmatchcase(case["id"], pattern)]
        mine = [claim for claim in claims if claim.claim.part == part.name and claim.cases]
        compared = [n for n in numbers if n.part == part.name]
        if mine or compared or drawn:
            found.append(Shown(part, mine, compared, drawn))
    return found
