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
    Figure(
        "surfaces/ensemble",
        ("lag / l", "estimate", "eq9", "standard error"),
        lines(
            "lag / l",
            {"estimate": "ensemble", "eq9": "Eq. (9)"},
            xlabel="lag / correlation length",
            ylabel="autocorrelation",
            errors="standard error",
        ),
        "Autocorrelation of an ensemble of rough surfaces and of Eq. (9).",
    ),
    Figure(
        "surfaces/spectrum",
        ("k l", "power / eq9", "standard error"),
        lines(
            "k l",
            {"power / eq9": "ensemble"},
            xlabel="wavenumber x correlation length",
            ylabel="power / that of Eq. (9)",
            errors="standard error",
        ),
        "Power of the periodic rough surface by wavenumber, over the Fourier transform of Eq. (9).",
    ),
)


def declared_for(case_id: str) -> Figure | None:
    """The first figure whose glob matches the case's id."""
    return next((figure for figure in FIGURES if fnmatchcase(case_id, figure.cases)), None)
