"""Which case has which figure. A case without an entry has none; an entry without its data says so."""

from __future__ import annotations

from fnmatch import fnmatchcase

from reports.drawing import Figure, dots, lines, maps, order, svg

__all__ = ["FIGURES", "Figure", "declared_for", "maps", "order", "svg"]

FIGURES = (
    Figure(
        "kernels/textbook-*-fails",
        ("offset", "textbook", "production"),
        lines(
            "offset",
            {"textbook": "textbook form, median", "production": "this code, largest"},
            xlabel="distance (elements)",
            ylabel="relative error",
            log="xy",
            marker=True,
        ),
        "Relative error of the textbook form and of this code, over the distance from the loaded element.",
    ),
    Figure(
        "kernels/*-50-digits",
        ("worst",),
        dots("worst", xlabel="largest relative error", limit=1e-14),
        "Largest relative error by group of points.",
    ),
)


def declared_for(case_id: str) -> Figure | None:
    """The first figure whose glob matches the case's id."""
    return next((figure for figure in FIGURES if fnmatchcase(case_id, figure.cases)), None)
