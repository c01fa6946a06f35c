"""Kinds of figures, drawn from a case's series, and their export as SVG for light, dark and print."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas
from matplotlib.ticker import NullLocator

from reports.inline_svg import inline
from reports.text import symbols

Data = Mapping[str, Any]
Draw = Callable[[Canvas, Data], None]

# Three of Okabe and Ito 2008, and three that readers with any kind of colour blindness distinguish from them.
# All have a contrast of at least 3:1 with the light and the dark page; black is left to the text.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#9888A8", "#786838", "#586868")
MARKERS = "os^Dv<"
INK = "#010203"  # stands for the page's text colour until the export
STYLE: dict[Any, Any] = {
    "axes.edgecolor": INK, "axes.labelcolor": INK, "axes.titlecolor": INK, "text.color": INK,
    "xtick.color": INK, "ytick.color": INK, "grid.color": "#808080", "grid.alpha": 0.35, "axes.grid": True,
    "legend.frameon": False, "legend.fontsize": 9, "font.size": 10, "lines.linewidth": 1.4,
    "lines.markersize": 5,
    "svg.hashsalt": "rough-friction", "svg.fonttype": "none", "font.family": ["DejaVu Sans"],
    "text.parse_math": True,
}  # fmt: skip
_TEXT = re.compile(r"(<text\b[^>]*>)([^<]*)(</text>)")
_NAME = re.compile(r"[\w/]+(-\w+)+")
WIDTH = 4.2
"""Inches of every figure, one panel: exponents of 7 points have 9 px where a phone shows it 396 px wide."""
HEIGHT = 3.4


def below(canvas: Canvas, axes: Axes) -> None:
    """Put the legend of the axes below all panels, where it covers no data."""
    handles, labels = axes.get_legend_handles_labels()
    columns = 2 if sum(sorted(map(len, labels))[-2:]) < 44 else 1
    canvas.legend(handles, labels, loc="outside lower center", ncols=columns)


def look(k: int) -> dict[str, Any]:
    """Return colour and marker of the k-th series."""
    return {"color": COLOURS[k % len(COLOURS)], "marker": MARKERS[k % len(MARKERS)]}


@dataclass(frozen=True)
class Figure:
    """A declared figure: which cases (glob) it belongs to, the series it needs, and how it is drawn.

    ``{title}`` in the caption stands for the case's title. ``derived`` computes what is drawn beside the
    recorded series, so that the CSV has it as well.
    """

    cases: str
    needs: tuple[str, ...]
    draw: Draw
    caption: str
    height: float = HEIGHT
    derived: Callable[[Data], Data] = field(default=lambda _: {})

    def available(self, data: Data) -> bool:
        """Return True if every series that the plot needs is there and not empty."""
        return all(data.get(name) not in (None, [], {}) for name in self.needs)


def complete(figure: Figure, data: Data) -> Data:
    """Return the recorded series and those derived from them."""
    return {**data, **figure.derived(data)}


def svg(figure: Figure, data: Data, name: str = "figure", caption: str | None = None) -> str | None:
    """Return the drawn figure for a page in the reader's colours; None without its series.

    ``name`` is unique on the page: ids begin with it. ``caption`` replaces the figure's own.
    """
    if not figure.available(data):
        return None
    data = complete(figure, data)
    with matplotlib.rc_context(STYLE):
        canvas = Canvas(figsize=(WIDTH, figure.height), layout="constrained")
        figure.draw(canvas, data)
        buffer = io.StringIO()
        # No date: the same results give the same bytes.
        canvas.savefig(buffer, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
        alt = symbols(words(canvas, figure.caption if caption is None else caption))
    made = _TEXT.sub(lambda text: text[1] + _in_symbols(text[2]) + text[3], buffer.getvalue())
    return inline(made.replace(INK, "currentColor"), name, alt)


def _in_symbols(text: str) -> str:
    """Return the text with Greek letters and units as symbols, unless it is the name of a case or a fault."""
    return text if _NAME.fullmatch(text) else symbols(text)


def words(canvas: Canvas, caption: str) -> str:
    """Return the alternative text: the caption, then axes and labelled series of every panel."""
    said = [caption]
    for axes in canvas.axes:
        title, x, y = (_plain(text) for text in (axes.get_title(), axes.get_xlabel(), axes.get_ylabel()))
        if not (x or y):
            continue
        panel = f"{title}: " if title else ""
        said.append(f"{panel}{y or 'rows'} over {x or 'columns'}.")
        labels = dict.fromkeys(_plain(text) for text in axes.get_legend_handles_labels()[1])
        if labels:
            said.append(f"Series: {'; '.join(labels)}.")
    return " ".join(dict.fromkeys(said))


def _plain(text: str) -> str:
    return re.sub(r"[$\\{}]", "", text).strip()


def curves(
    cases: str,
    caption: str,
    x: str,
    series: Mapping[str, str],
    *,
    xlabel: str,
    ylabel: str,
    exact: Mapping[str, str] | None = None,
    points: Mapping[str, str] | None = None,
    band: tuple[str, str] | None = None,
    log: str = "",
    marker: bool = False,
    per_x: float = 1.0,
    difference: str = "",
    height: float = HEIGHT,
) -> Figure:
    """Return the figure of series (key to legend text) over `x`, and those of `exact` dashed; `points` are
    open markers in the colours of the series.

    `band` is the key and the legend text of the first series' half width, drawn around it; `log` names the
    logarithmic axes, "", "x", "y" or "xy"; `x` is multiplied by `per_x`. `difference` labels a second panel,
    of the first series less the first exact one: curves that coincide show nothing else. The figure needs all
    series that it draws.
    """
    exact, points = exact or {}, points or {}

    def draw(canvas: Canvas, data: Data) -> None:
        over, middle = per_x * _numbers(data[x]), _numbers(data[next(iter(series))])
        axes, lower = canvas.add_subplot(), None
        if difference:
            canvas.clear()
            axes, lower = canvas.subplots(2, 1, sharex=True, height_ratios=(2, 1))
            less = middle - _numbers(data[next(iter(exact))])
            lower.plot(over, less, color=COLOURS[0])
            lower.set_ylabel(difference)
        (lower or axes).set_xlabel(xlabel)
        _scale(axes, log)
        axes.set_ylabel(ylabel)
        for k, (key, label) in enumerate(series.items()):
            style = look(k) if marker else {"color": look(k)["color"]}
            axes.plot(over, _numbers(data[key]), label=label, **style)
        for k, (key, label) in enumerate(points.items()):
            axes.plot(over, _numbers(data[key]), label=label, **look(k), linestyle="", markerfacecolor="none")
        for dashes, (key, label) in zip(("--", ":", "-."), exact.items(), strict=False):
            axes.plot(over, _numbers(data[key]), dashes, color=INK, label=label)
        if band is not None:
            width = _numbers(data[band[0]])
            shade: dict[str, Any] = {"color": COLOURS[0], "alpha": 0.2, "label": band[1]}
            axes.fill_between(over, middle - width, middle + width, **shade)
            if lower is not None:
                lower.fill_between(over, less - width, less + width, **shade)
        if "x" in log:
            _few_ticks(axes, over)
        below(canvas, axes)

    needs = dict.fromkeys((x, *series, *points, *exact, *(band or ())[:1]))
    return Figure(cases, tuple(needs), draw, caption, height)


def maps(fields: Mapping[str, str], *, side: str | None, unit: str, colours: str = "viridis") -> Draw:
    """Return maps (key to title) of arrays ``[i, j]`` along x, y, one colour bar each; zero is blank."""

    def draw(canvas: Canvas, data: Data) -> None:
        panels = canvas.subplots(len(fields), 1, squeeze=False)[:, 0]
        for axes, (key, title) in zip(panels, fields.items(), strict=True):
            field = np.ma.masked_equal(_numbers(data[key]), 0.0)
            edge = float(data[side]) if side is not None else field.shape[0]
            extent = (0.0, edge, 0.0, edge)
            image = axes.imshow(field.T, cmap=colours, origin="lower", extent=extent, interpolation="none")
            length = "mm" if side is not None else "elements"
            axes.set(title=title, xlabel=f"x ({length})", ylabel=f"y ({length})")
            axes.grid(visible=False)
            canvas.colorbar(image, ax=axes, label=unit, shrink=0.85)

    return draw


def label_ticks(axes: Axes, values: Iterable[float]) -> None:
    """Label the x axis at the values alone, as a logarithmic axis needs it."""
    values = list(values)
    axes.set_xticks(values, [f"{value:g}" for value in values])
    axes.xaxis.set_minor_locator(NullLocator())


def _scale(axes: Axes, log: str) -> None:
    axes.set_xscale("log" if "x" in log else "linear")
    axes.set_yscale("log" if "y" in log else "linear")


def _few_ticks(axes: Axes, x: np.ndarray[Any, np.dtype[np.float64]]) -> None:
    """Set ticks at the points of a logarithmic axis within two decades; close ones have none."""
    if not 0 < x.max() < 100 * x.min():
        return
    kept = [x.min()]
    for value in np.unique(x):
        if value > kept[-1] * (x.max() / x.min()) ** 0.08:
            kept.append(value)
    axes.set_xticks(kept, [f"{value:.4g}" if value % 1 == 0 else f"{value:.3g}" for value in kept])
    axes.xaxis.set_minor_locator(NullLocator())


def _numbers(series: Sequence[Any]) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return the floats with NaN for what was recorded as not available."""
    return np.array(series, dtype=float)
