"""Pictures of the command line: file formats, colours, units at scale, and how a picture is written."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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


class Unit(NamedTuple):
    """A unit for people: its name, and how many SI units it is."""

    name: str
    size: float


LENGTHS = (Unit("nm", 1e-9), Unit("µm", 1e-6), Unit("mm", 1e-3), Unit("m", 1.0))
PRESSURES = (Unit("Pa", 1.0), Unit("kPa", 1e3), Unit("MPa", 1e6), Unit("GPa", 1e9))


def unit_at_scale(value: float, units: tuple[Unit, ...]) -> Unit:
    """Return the largest unit of which the value has at least one, or the smallest unit.

    >>> unit_at_scale(4.1e-4, LENGTHS).name, unit_at_scale(0.8e9, PRESSURES).name
    ('µm', 'MPa')
    >>> unit_at_scale(0.0, LENGTHS).name
    'nm'
    """
    return next((unit for unit in reversed(units) if abs(value) >= unit.size * (1 - 1e-9)), units[0])


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
