"""The first page: what was checked, what holds, what does not, how sure we are, and how to run it again."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from reports.agreement import Number, by_quantity, fine, ratio_and_scatter
from reports.claims import VERDICTS, Judged, of_the_conversion
from reports.evidence import Evidence
from reports.result_tables.accuracy import JUDGED
from reports.results import Case
from reports.studies.experiments import sentences
from reports.text import number, unit_of

HERTZ = {
    "hertz/peak-pressure": "peak pressure",
    "hertz/approach": "approach",
    "hertz/radius-corrected": "contact radius",
}


@dataclass(frozen=True)
class FrontPage:
    """Contents of the first page; tables are rows of texts."""

    verdicts: Mapping[str, Sequence[Judged]]
    table3: Sequence[Number]
    beyond: int
    worst: Sequence[Number]
    """The number farthest from the printed one of each of the three worst quantities, of those beyond u."""
    hertz: Sequence[str]
    quantities: Sequence[tuple[str, int, str, str, int]]
    conversion: int
    """Errata that may be faults of the text's conversion."""
    trust: Sequence[str]
    experiments: Sequence[str]
    """Sentences on predictions beside measurements; none where no result file has them."""

    @property
    def table3_rows(self) -> Mapping[str, Sequence[Number]]:
        """Table 3 on the fine mesh by quantity, the roughnesses in order."""
        rows: dict[str, list[Number]] = {}
        for n in self.table3:
            name = n.quantity.removesuffix(", Table 3")
            rows.setdefault(f"{name} ({n.unit})" if n.unit else name, []).append(n)
        return rows

    @property
    def roughness(self) -> Sequence[str]:
        """The columns' equivalent roughness."""
        labels = (n.label.partition(",")[0].removeprefix("σ_e ") for n in self.table3)
        return list(dict.fromkeys(labels))


def front_page(evidence: Evidence, claims: Sequence[Judged], numbers: Sequence[Number]) -> FrontPage:
    """Collect the page from the evidence; what is missing leaves its rows out."""
    table3 = fine(numbers)
    return FrontPage(
        verdicts={v: [c for c in claims if c.verdict == v] for v in VERDICTS},
        table3=table3,
        beyond=sum(not n.within for n in table3),
        worst=_worst(numbers),
        hertz=[said for said in map(_hertz, evidence.cases) if said],
        quantities=[_quantity(name, group) for name, group in by_quantity(numbers).items()],
        conversion=sum(erratum["equation"] in of_the_conversion() for erratum in evidence.errata),
        trust=[*_coverage(evidence.studies), *_trust(evidence.studies)],
        experiments=sentences(evidence.studies["experiments"]) if "experiments" in evidence.studies else [],
    )


def _worst(numbers: Sequence[Number], count: int = 3) -> list[Number]:
    """Of the quantities with a number beyond u the worst, each by its largest ratio to the printed number."""

    def distance(n: Number) -> float:
        return abs(math.log(n.ratio))

    beyond = [[n for n in group if not n.within] for group in by_quantity(numbers).values()]
    return sorted((max(group, key=distance) for group in beyond if group), key=distance, reverse=True)[:count]


def _hertz(case: Case) -> str:
    """Computed and exact number, and the relative error; empty for another case."""
    name = HERTZ.get(case["id"])
    if name is None or case["value"] is None or case["reference"] is None:
        return ""
    unit, scale = unit_of(case)
    value, reference = (f"{scale * case[key]:.6g}" for key in ("value", "reference"))
    return f"{name} {value} for {reference} {unit} ({case['error']:.1e})"


def _quantity(name: str, group: Sequence[Number]) -> tuple[str, int, str, str, int]:
    mean, scatter = ratio_and_scatter(group)
    return (
        name,
        len(group),
        f"{mean:.3g}" if mean >= 2 else f"{mean:.3f}",
        "" if scatter is None else f"{scatter:.3f}",
        sum(n.within for n in group),
    )


def _coverage(studies: Mapping[str, Any]) -> list[str]:
    """Coverage of error bars over all classes of random scenes."""
    table = studies.get("coverage_corrected", {}).get("table", ())
    said = [
        f"{JUDGED[row['number']]} in {100 * row['held']:.0f} % of {row['scenes']} "
        f"({number(row['median_bar_over_error'], 2)} times the error)"
        for row in table
        if row["class"] is None and row["number"] in JUDGED
    ]
    samples = "95 % error bars of single grids hold far finer solutions of random scenes"
    return [f"{samples}: {'; '.join(said)}"] if said else []


def _trust(studies: Mapping[str, Any]) -> list[str]:
    """One sentence a study of the verification itself."""
    said = []
    if "extremes" in studies:
        counts = studies["extremes"]["counts"]
        said.append(
            f"{counts['wrong']} of {sum(counts.values())} extreme inputs gave a wrong answer, "
            f"{counts['crash']} a crash, and {counts['honest failure']} a status that says that they failed"
        )
    return said
