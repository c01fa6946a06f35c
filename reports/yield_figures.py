"""Figures of contact beyond yield: section 8 with a cap on the pressure, a sphere against published laws."""

from __future__ import annotations

from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas

from reports.drawing import COLOURS, INK, MARKERS, Data, Figure, lines

_LOADS = ("14 N", "42 N", "70 N")
_MODELS = {"elastic": "--", "capped": "-"}


def _curves(axes: Axes, data: Data, name: str, half: str) -> None:
    """Elastic and capped means with 95 % intervals over sigma_e, one colour a load."""
    for k, load in enumerate(_LOADS):
        for model, line in _MODELS.items():
            style: dict[str, Any] = {"color": COLOURS[k], "marker": MARKERS[k], "linestyle": line}
            width, label = data[f"{half}, {model}, {load}"], f"{model}, P = {load}"
            axes.errorbar(
                data["sigma_e (um)"],
                data[f"{name}, {model}, {load}"],
                width,
                label=label,
                capsize=2,
                **style,
            )
    axes.set_xlabel("$\\sigma_e$ (µm)")


def _section8(canvas: Canvas, data: Data) -> None:
    (friction, area), (pressure, share) = canvas.subplots(2, 2)
    _curves(friction, data, "mu", "mu half width")
    friction.axhline(float(data["Eq. (11)"]), color=INK, linestyle=":", label="Eq. (11)")
    friction.set(ylabel="friction coefficient", title="(a)", ylim=(0.08, 0.15))
    _curves(area, data, "A (mm^2)", "A half width (mm^2)")
    area.set(ylabel="contact area (mm²)", title="(b)", yscale="log")
    for k, load in enumerate(_LOADS):
        style: dict[str, Any] = {"color": COLOURS[k], "marker": MARKERS[k]}
        for model, line in _MODELS.items():
            pressure.plot(data["psi"], data[f"mean pressure / H, {model}, {load}"], line, **style)
        share.plot(data["psi"], data[f"plastic share, {load}"], **style)
    pressure.axhline(1.0, color=INK, linestyle=":")
    psi = "$\\psi$, Eq. (12) with the correlation length"
    pressure.set(xlabel=psi, ylabel="mean contact pressure / H", title="(c)", ylim=(0, 2))
    share.set(xlabel=psi, ylabel="plastic share of the contact", title="(d)", ylim=(0, 1))
    canvas.legend(*friction.get_legend_handles_labels(), loc="outside lower center", ncols=4)


def _table3(canvas: Canvas, data: Data) -> None:
    axes, x = canvas.add_subplot(), data["sigma_e (um)"]
    axes.plot(x, data["printed mu"], "x", color=INK, label="Table 3, printed")
    axes.plot(x, data["elastic mu"], "--", marker="o", color=COLOURS[0], label="elastic")
    half = data["capped mu half width"]
    axes.errorbar(x, data["capped mu"], half, marker="s", capsize=3, color=COLOURS[1], label="capped")
    axes.axhline(float(data["Eq. (11)"]), color=INK, linestyle=":", label="Eq. (11)")
    axes.set(xlabel="$\\sigma_e$ (µm)", ylabel="friction coefficient")
    axes.legend()


_EXCESS = {f"mu / Eq. (11) - 1, {load}": f"P = {load}" for load in _LOADS}
_PRESSURES = {"mean pressure / H, cap": "pressure cap", "mean pressure / H, law": "finite-element law"}

BEYOND_YIELD = (
    Figure(
        "reproduction/eq11-capped-bound*",
        ("sigma_e (um)", "psi", "Eq. (11)", *(f"plastic share, {load}" for load in _LOADS)),
        _section8,
        "Section 8, elastic (dashed) and with pressures that end at the hardness: friction, contact area, "
        "mean pressure and plastic share; bars are 95 % intervals.",
        (8.6, 7.4),
    ),
    Figure(
        "reproduction/eq11-capped-estimate*",
        ("psi", *_EXCESS),
        lines(
            "psi",
            _EXCESS,
            xlabel="$\\psi$",
            ylabel="$\\mu$ / Eq. (11) - 1",
            log="y",
            marker=True,
        ),
        "How far the capped friction coefficient lies above Eq. (11), over the plasticity index.",
    ),
    Figure(
        "reproduction/table3-capped*",
        ("sigma_e (um)", "printed mu", "elastic mu", "capped mu", "capped mu half width", "Eq. (11)"),
        _table3,
        "Friction of Table 3's rough columns: printed, elastic and capped, with 95 % intervals.",
    ),
    Figure(
        "capped/sphere-[kj]*",
        ("load / load of first yield", *_PRESSURES),
        lines(
            "load / load of first yield",
            _PRESSURES,
            xlabel="load / load of first yield",
            ylabel="mean contact pressure / H",
            log="x",
            marker=True,
        ),
        "{title}: mean pressure of the capped model, and the published law.",
    ),
)
