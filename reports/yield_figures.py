"""Figures of contact beyond yield: section 8 with a cap on the pressure, a sphere against published laws."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas

from reports.drawing import COLOURS, INK, Data, Figure, curves, look
from reports.reproduction_figures import LOADS, PSI, SIGMA

MODELS = {"elastic": "--", "capped": "-"}


def _means(axes: Axes, data: Data, name: str, half: str) -> None:
    """Elastic and capped means with 95 % intervals over sigma_e, one colour a load."""
    for k, load in enumerate(LOADS):
        for model, line in MODELS.items():
            means, widths = data[f"{name}, {model}, {load}"], data[f"{half}, {model}, {load}"]
            style = {"linestyle": line, "capsize": 2, "label": f"{model}, P = {load}", **look(k)}
            axes.errorbar(data["sigma_e (um)"], means, widths, **style)
    axes.set_xlabel(SIGMA)


def _section8(canvas: Canvas, data: Data) -> None:
    (friction, area), (pressure, share) = canvas.subplots(2, 2)
    _means(friction, data, "mu", "mu half width")
    friction.axhline(float(data["Eq. (11)"]), color=INK, linestyle=":", label="Eq. (11)")
    friction.set(ylabel="friction coefficient", title="(a)", ylim=(0.08, 0.15))
    _means(area, data, "A (mm^2)", "A half width (mm^2)")
    area.set(ylabel="contact area (mm²)", title="(b)", yscale="log")
    for k, load in enumerate(LOADS):
        for model, line in MODELS.items():
            pressure.plot(data["psi"], data[f"mean pressure / H, {model}, {load}"], line, **look(k))
        share.plot(data["psi"], data[f"plastic share, {load}"], **look(k))
    pressure.axhline(1.0, color=INK, linestyle=":")
    pressure.set(xlabel=PSI, ylabel="mean contact pressure / H", title="(c)", ylim=(0, 2))
    share.set(xlabel=PSI, ylabel="plastic share of the contact", title="(d)", ylim=(0, 1))
    canvas.legend(*friction.get_legend_handles_labels(), loc="outside lower center", ncols=4)


def _table3(canvas: Canvas, data: Data) -> None:
    axes, x = canvas.add_subplot(), data["sigma_e (um)"]
    axes.plot(x, data["printed mu"], "x", color=INK, label="Table 3, printed")
    axes.plot(x, data["elastic mu"], "--", marker="o", color=COLOURS[0], label="elastic")
    half = data["capped mu half width"]
    axes.errorbar(x, data["capped mu"], half, marker="s", capsize=3, color=COLOURS[1], label="capped")
    axes.axhline(float(data["Eq. (11)"]), color=INK, linestyle=":", label="Eq. (11)")
    axes.set(xlabel=SIGMA, ylabel="friction coefficient")
    axes.legend()


BEYOND_YIELD = (
    Figure(
        "reproduction/eq11-capped-bound*",
        ("sigma_e (um)", "psi", "Eq. (11)", *(f"plastic share, {load}" for load in LOADS)),
        _section8,
        "Section 8, elastic (dashed) and with pressures that end at the hardness: friction, contact area, "
        "mean pressure and plastic share; bars are 95 % intervals.",
        (8.6, 7.4),
    ),
    curves(
        "reproduction/eq11-capped-estimate*",
        "How far the capped friction coefficient lies above Eq. (11), over the plasticity index.",
        "psi",
        {f"mu / Eq. (11) - 1, {load}": f"P = {load}" for load in LOADS},
        xlabel="$\\psi$",
        ylabel="$\\mu$ / Eq. (11) - 1",
        log="y",
        marker=True,
    ),
    Figure(
        "reproduction/table3-capped*",
        ("sigma_e (um)", "printed mu", "elastic mu", "capped mu", "capped mu half width", "Eq. (11)"),
        _table3,
        "Friction of Table 3's rough columns: printed, elastic and capped, with 95 % intervals.",
    ),
    curves(
        "capped/sphere-[kj]*",
        "{title}: mean pressure of the capped model, and the published law.",
        "load / load of first yield",
        {"mean pressure / H, cap": "pressure cap", "mean pressure / H, law": "finite-element law"},
        xlabel="load / load of first yield",
        ylabel="mean contact pressure / H",
        log="x",
        marker=True,
    ),
)
