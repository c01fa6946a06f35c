"""Pictures of the command line: file formats, colours, units at scale, and how a picture is written."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from refimpl.solution.units import Unit

# Okabe and Ito 2008, safe for colour-blind readers
BLUE, ORANGE, GREEN, PINK, BLACK = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000"
PRINT: Any = {  # sizes in points: at full page width (180 mm) no letter is smaller than 6 points
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.linewidth": 0.6,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "legend.fontsize": 7,
    "pdf.fonttype": 42,  # text stays text
    "svg.fonttype": "path",
}
DPI = 200


def scaled_unit(value: float, unit: str) -> Unit:
    """Return the unit of an axis, at the scale of a value in this SI unit.

    >>> scaled_unit(4.1e-4, "m").name
    'µm'
    """
    from refimpl.solution.units import unit_at_scale

    found = unit_at_scale(value, unit)
    return found._replace(name=found.name.replace("u", "µ"))


@contextmanager
def print_style() -> Iterator[None]:
    """Make figures for print within the block, without a display."""
    import matplotlib

    matplotlib.use("Agg")
    with matplotlib.rc_context(PRINT):
        yield


def subplots(*shape: int, **options: Any) -> tuple[Figure, Any]:
    """Return a figure and its axes, as pyplot does, without a display."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    return plt.subplots(*shape, layout="constrained", **options)


def write(figure: Figure, path: Path, dpi: int = DPI) -> None:
    """Write a figure in the format of its suffix, in one step, and close it."""
    import matplotlib.pyplot as plt

    from verification.output.files import replacing

    try:
        with replacing(path) as temporary:
            figure.savefig(temporary, dpi=dpi, format=path.suffix[1:])
    finally:
        plt.close(figure)
