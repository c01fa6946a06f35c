"""Table 2: the cost of the paper's scheme beside energy minimisers and the production solver."""

from __future__ import annotations

from typing import Any

from reports.drawing import curves
from reports.exhibit import Document, Exhibit, Table


def build(document: Document) -> Exhibit:
    """Processor seconds over the grid, growth exponents, and cost over the paper's."""
    rows = document["rows"]
    grids = sorted({row["M"] for row in rows})
    methods = list(dict.fromkeys(row["method"] for row in rows))
    seconds: dict[str, list[Any]] = {
        method: [
            min((min(r["cpu"]) for r in rows if r["method"] == method and r["M"] == M), default=None)
            for M in grids
        ]
        for method in methods
    }
    figure = curves(
        "*",
        "Processor time on the same scene; the methods took turns on every grid.",
        "M",
        {method: method for method in methods},
        xlabel="elements per side",
        ylabel="processor time (s)",
        log="xy",
        marker=True,
    )
    ratios = document["ratio to paper"]
    head = ("method", "time grows with elements to the power", *(f"{M}²" for M in grids))
    table = Table(
        "Growth, and cost over that of the paper's scheme at a given approach, by grid.",
        head,
        [(m, document["growth"].get(m), *(ratios.get(m, {}).get(str(M)) for M in grids)) for m in methods],
    )
    return Exhibit(
        "Table 2 run again",
        (f"Slopes: {document['slopes']}.", f"Clock: {document['conditions']['clock']}."),
        [table],
        [(figure, {"M": grids, **seconds})],
    )
