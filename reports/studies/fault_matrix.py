"""Quick checks against seeded faults: what each sees, what it alone sees, and what it is for if nothing."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np
from matplotlib.figure import Figure as Canvas

from reports.drawing import COLOURS, Data, Figure
from reports.exhibit import Document, Exhibit, Table

BLUE, RED = COLOURS[:2]
JUDGES = {
    "appendix": "judges the paper's appendix and the plane solutions behind it",
    "fem3d": "judges finite elements in three dimensions, which the solver does not call",
    "errata": "judges what the paper prints, with numbers of its own",
    "reproduction": "judges a sentence or a figure of the paper, with the width that the paper's words have",
    "kernels": "judges a textbook's formula, a bound, or a reference against another reference",
    "model-form": "judges the model against finite elements, within the model's own error",
    "surfaces": "judges a number that the paper quotes",
    "variational": "compares the cost or the results of other methods",
    "golden/proven-anew": "judges the stored proofs by proving them again, without a solver",
    "contestants": "judges the suite itself by solvers that are wrong on purpose",
}
"""Why a check stays that sees none of the faults, by the beginning of its name."""


def build(document: Document) -> Exhibit:
    """Summary, faults with the checks that see them, checks that see nothing, and the matrix as a figure."""
    faults, checks = document["faults"], document["checks"]
    alone = [check for check in checks if check["alone"]]
    silent = [check for check in checks if not check["catches"]]
    missed = [fault["name"] for fault in faults if not fault["caught_by"]]
    summary = (
        f"{len(checks)} checks (quick cases and invariants) were run with each of {len(faults)} faults that "
        f"they could see. {len(faults) - len(missed)} faults are detected; not detected: "
        f"{', '.join(missed) or 'no fault'}. {len(alone)} checks are the only ones to see some fault, "
        f"{len(silent)} see none. {len(document['excluded'])} checks were excluded for the time they take."
    )
    return Exhibit(
        "Checks against seeded faults",
        (summary,),
        (_by_fault(faults), _alone(alone), _silent(silent)),
        ((FIGURE, _series(document)),),
    )


def purpose(check: str) -> str:
    """Why a check stays that sees no fault.

    >>> purpose("errata/hertz")
    'judges what the paper prints, with numbers of its own'
    """
    beginning = next((name for name in JUDGES if check.startswith(name)), None)
    return "guards a part that none of these faults is in" if beginning is None else JUDGES[beginning]


def _by_fault(faults: list[dict[str, Any]]) -> Table:
    rows = [
        (
            fault["name"],
            fault["what"],
            fault["tried"],
            len(fault["caught_by"]),
            fault["broke"],
            _few(fault["caught_by"]),
        )
        for fault in sorted(faults, key=lambda fault: len(fault["caught_by"]))
    ]
    return Table(
        "Faults, those that fewest see first.",
        ("fault", "what", "tried", "caught", "of which broke", "by"),
        rows,
    )


def _alone(checks: list[dict[str, Any]]) -> Table:
    rows = [(check["id"], ", ".join(check["alone"]), len(check["catches"])) for check in checks]
    return Table("Checks that see what no other does.", ("check", "alone", "caught in all"), rows)


def _silent(checks: list[dict[str, Any]]) -> Table:
    rows = [(check["id"], purpose(check["id"])) for check in checks]
    return Table("Checks that see none of these faults, and why they stay.", ("check", "why"), rows)


def _few(names: list[str], most: int = 4) -> str:
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more


def _series(document: Document) -> dict[str, Any]:
    """Subjects by faults: how many of a subject's checks see the fault."""
    faults = [fault["name"] for fault in document["faults"]]
    subjects = list(dict.fromkeys(check["id"].partition("/")[0] for check in document["checks"]))
    counts: Counter[tuple[str, str]] = Counter()
    for check in document["checks"]:
        counts.update((check["id"].partition("/")[0], fault) for fault in check["catches"])
    size = Counter(check["id"].partition("/")[0] for check in document["checks"])
    return {
        "subject": [f"{subject} ({size[subject]})" for subject in subjects],
        "fault": faults,
        "checks that see it": [[counts[subject, fault] for fault in faults] for subject in subjects],
        "seen by one check alone": [len(fault["caught_by"]) == 1 for fault in document["faults"]],
    }


def _draw(canvas: Canvas, data: Data) -> None:
    """Numbers of checks, subjects over faults; the faults that one check alone sees are in red."""
    axes = canvas.add_subplot()
    counts = np.array(data["checks that see it"])
    sole = data["seen by one check alone"]
    for row, column in zip(*np.nonzero(counts), strict=True):
        colour = RED if sole[column] else BLUE
        axes.text(column, row, str(counts[row, column]), ha="center", va="center", color=colour, fontsize=7)
    axes.set_xticks(range(len(data["fault"])), data["fault"], rotation=90, fontsize=7.5)
    axes.set_yticks(range(len(data["subject"])), data["subject"], fontsize=8)
    axes.set(xlim=(-0.7, len(data["fault"]) - 0.3), ylim=(len(data["subject"]) - 0.4, -0.6))
    axes.grid(alpha=0.15)
    axes.set_xlabel("seeded fault (red numbers: seen by one check alone)")
    axes.set_ylabel("subject (number of its checks)")


FIGURE = Figure(
    "*",
    ("subject", "fault", "checks that see it", "seen by one check alone"),
    _draw,
    "How many checks of each subject see a fault.",
    (12.5, 6.0),
)
