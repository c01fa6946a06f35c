"""The paper's figures again, with its axes: one drawing for each, from the reproduction cases' series."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure as Canvas

from reports.agreement import column_of
from reports.drawing import COLOURS, INK, MARKERS, Data, Figure, below, look, maps

DASHED, DOTTED, DASH_DOT = "--", ":", "-."
LOADS = ("14 N", "42 N", "70 N")
SIGMA = "$\\sigma_e$ (µm)"
PSI = "$\\psi$, Eq. (12) with the correlation length"
FIG11 = ("undeformed height", "undeformed slope", "deformed height in contact", "deformed slope in contact")


def _values(data: Data, name: str) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    return np.array(data[name], dtype=float)


def _table3(canvas: Canvas, data: Data) -> None:
    axes = canvas.add_subplot()
    mesh, rms = _values(data, "mesh"), _values(data, "sigma_e (um)")
    ratio = _values(data, "ours") / _values(data, "printed")
    half = _values(data, "u 95 %") / _values(data, "printed")
    for k, sigma in enumerate(np.unique(rms)):
        here = rms == sigma
        x = np.log2(mesh[here]) + 0.06 * (k - 1.5)
        label = column_of(sigma)
        axes.errorbar(x, ratio[here], half[here], label=label, capsize=3, **look(k))
    axes.axhline(1.0, color=INK, linestyle=DASHED)
    meshes = np.unique(mesh)
    axes.set_xticks(np.log2(meshes), [f"{m:.0f}²" for m in meshes])
    axes.set(xlabel="mesh", ylabel="this code / printed")
    below(canvas, axes)


def _fig5_differences(data: Data) -> dict[str, list[float]]:
    return {
        f"{ours}{suffix} less {theirs} (MPa)": list(
            _values(data, f"{ours}{suffix} (MPa)") - _values(data, f"{theirs} (MPa)")
        )
        for suffix in ("", " across")
        for ours, theirs in (("pressure", "hertz"), ("traction", "coulomb"))
    }


def _fig5(canvas: Canvas, data: Data) -> None:
    x = _values(data, "x (mm)")
    panels = canvas.subplots(4, 1, sharex=True, height_ratios=(2, 1, 2, 1)).reshape(2, 2)
    for (axes, lower), suffix, title in zip(
        panels, ("", " across"), ("(a) along sliding", "(b) across"), strict=True
    ):
        axes.plot(x, data[f"pressure{suffix} (MPa)"], color=COLOURS[0], label="normal stress")
        axes.plot(x, data[f"traction{suffix} (MPa)"], color=COLOURS[1], label="tangential stress")
        axes.plot(x, data["hertz (MPa)"], DOTTED, color=INK, label="Hertz")
        axes.plot(x, data["coulomb (MPa)"], DASHED, color=INK, label="Coulomb, same $\\mu$")
        lower.plot(x, data[f"pressure{suffix} less hertz (MPa)"], color=COLOURS[0])
        lower.plot(x, data[f"traction{suffix} less coulomb (MPa)"], color=COLOURS[1])
        axes.set(ylabel="stress (MPa)", title=title)
        lower.set_ylabel("difference (MPa)")
    canvas.axes[-1].set_xlabel("distance from the centre (mm)")
    below(canvas, canvas.axes[0])


def _fig6(canvas: Canvas, data: Data) -> None:
    axes = canvas.add_subplot()
    r = _values(data, "r/a0")
    axes.plot(r, data["p/p0"], color=COLOURS[0], label="this code, mean")
    axes.fill_between(r, data["low"], data["high"], color=COLOURS[0], alpha=0.25, label="95 %, bootstrap")
    axes.plot(r, data["Hertz p/p0"], DASHED, color=INK, label="Hertz")
    axes.plot(r, data["Greenwood-Tripp p/p0"], DASH_DOT, color=COLOURS[1], label="Greenwood, Tripp: Eq. (9)")
    axes.plot(r, data["mu = 4 p/p0"], DOTTED, color=COLOURS[1], label="the same, $\\mu$ = 4")
    axes.set(xlabel="$r / a_0$", ylabel="effective pressure / $f_0$")
    below(canvas, axes)


def _fig6d(canvas: Canvas, data: Data) -> None:
    maps({"pressure map": "Contact pressure"}, side="side (mm)", unit="MPa")(canvas, data)
    axes, side = canvas.axes[0], float(data["side (mm)"])
    angle = np.linspace(0, 2 * np.pi, 200)
    radius = float(data["Hertz radius (mm)"])
    axes.plot(side / 2 + radius * np.cos(angle), side / 2 + radius * np.sin(angle), DASHED, color=COLOURS[1])


def _fig7_difference(data: Data) -> dict[str, list[float]]:
    """Return the change by friction, which is thinner than a line."""
    less = _values(data, "flat deformed (um)") - _values(data, "flat deformed, frictionless (um)")
    return {"with less without friction (nm)": list(1e3 * less)}


def _fig7(canvas: Canvas, data: Data) -> None:
    before, contact, change = canvas.subplots(3, 1, height_ratios=(3, 3, 1.5), sharex=True)
    x = _values(data, "x (mm)")
    for axes, state in ((before, "before"), (contact, "deformed")):
        axes.plot(x, data[f"ball {state} (um)"], color=COLOURS[1], label="ball")
        axes.plot(x, data[f"flat {state} (um)"], color=COLOURS[0], label="half-space")
    before.axhline(0.0, color=INK, linestyle=DASHED, label="mean plane")
    contact.plot(x, data["mean plane (um)"], DASHED, color=INK)
    change.plot(x, data["with less without friction (nm)"], color=COLOURS[2])
    for axes, title in ((before, "(a) before contact"), (contact, "(b) in contact")):
        axes.set(ylabel="height (µm)", title=title)
    change.set(xlabel="x from the centre (mm)", ylabel="by friction (nm)")
    below(canvas, before)


def _fig8(canvas: Canvas, data: Data) -> None:
    friction, area, rates = canvas.subplots(3, 1)
    sigma = _values(data, "sigma_e (um)")
    for k, load in enumerate(LOADS):
        style = {"capsize": 2, "label": f"P = {load}", **look(k)}
        friction.errorbar(sigma, data[f"mu, {load}"], data[f"mu half width, {load}"], **style)
        area.errorbar(sigma, data[f"A (mm^2), {load}"], data[f"A half width (mm^2), {load}"], **style)
        middle = data["sigma_e of rates (um)"]
        rates.plot(middle, data[f"rate of mu, {load}"], color=COLOURS[k], label="$\\mu$" if k == 0 else None)
        ring: dict[str, Any] = {"markerfacecolor": "none", "markersize": 7, "color": INK}
        rates.plot(middle, data[f"rate of A, {load}"], MARKERS[k], label="A" if k == 0 else None, **ring)
    per_micron = _values(data, "psi")[-1] / sigma[-1]
    above = friction.secondary_xaxis("top", (lambda s: s * per_micron, lambda p: p / per_micron))
    above.set_xlabel(PSI)
    for axes, ylabel in (
        (friction, "(a) friction coefficient"),
        (area, "(b) contact area (mm²)"),
        (rates, "(c) rate of change / first"),
    ):
        axes.set_ylabel(ylabel)
    rates.set_xlabel(SIGMA)
    rates.legend()
    below(canvas, friction)


def _fig9(canvas: Canvas, data: Data) -> None:
    axes = canvas.add_subplot()
    Q = _values(data, "Q (N)")
    largest = float(np.abs(Q).max())
    image = axes.pcolormesh(
        data["distance (um)"], data["direction (deg)"], Q, cmap="PuOr", vmin=-largest, vmax=largest
    )
    axes.grid(visible=False)
    axes.set(xlabel="sliding distance (µm)", ylabel="direction of sliding (degrees)")
    canvas.colorbar(image, ax=axes, label="transverse force Q (N)")


def _fig10(canvas: Canvas, data: Data) -> None:
    above, lower = canvas.subplots(2, 1)
    x = _values(data, "direction (deg)")
    for axes, start, ylabel in (
        (above, "elastic / F, ", "elastic part / F"),
        (lower, "F / mean - 1, ", "F / mean - 1"),
    ):
        for k, name in enumerate(name for name in data if name.startswith(start)):
            label = f"$\\sigma$ = {name.removeprefix(start).replace('um', 'µm')}"
            axes.plot(x, data[name], label=label, **look(k))
        axes.set(xlabel="direction of sliding (degrees)", ylabel=ylabel)
    below(canvas, above)


def _fig11_gaussians(data: Data) -> dict[str, list[float]]:
    found = {}
    for panel in FIG11:
        x, density = _values(data, f"{panel}: value"), _values(data, f"{panel}: density")
        rms = float(np.sqrt(np.sum(density * x**2) / np.sum(density)))
        gauss = np.exp(-0.5 * (x / rms) ** 2) / (rms * np.sqrt(2 * np.pi))
        found[f"{panel}: Gaussian"] = [float(value) for value in gauss]
    return found


def _fig11(canvas: Canvas, data: Data) -> None:
    units = ("height from the mean (µm)", "slope from the mean (degrees)") * 2
    for axes, panel, letter, unit in zip(canvas.subplots(4, 1), FIG11, "abcd", units, strict=True):
        x, density = _values(data, f"{panel}: value"), _values(data, f"{panel}: density")
        axes.step(x, density, where="mid", color=COLOURS[0], label="all realisations")
        axes.plot(x, data[f"{panel}: Gaussian"], DASHED, color=INK, label="Gaussian of the same rms")
        (skew, half), (kurtosis, wide) = data[f"{panel}: skewness"], data[f"{panel}: kurtosis"]
        title = f"({letter}) skewness {skew:+.2f} ± {half:.2f}\nkurtosis {kurtosis:.2f} ± {wide:.2f}"
        axes.set_title(title, fontsize=9)
        axes.set(xlabel=unit, ylabel="density")
    below(canvas, canvas.axes[0])


def _traces(canvas: Canvas, data: Data) -> None:
    x = _values(data, "offset (um)")
    names = {"mu": "$\\mu$", "A (mm^2)": "A (mm²)", "elastic friction (N)": "elastic F (N)", "Q (N)": "Q (N)"}
    for axes, (name, label), colour in zip(canvas.subplots(4, 1), names.items(), COLOURS, strict=False):
        values = _values(data, name)
        axes.plot(x, values, color=colour)
        axes.axhline(values.mean(), color=INK, linestyle=DASHED)
        axes.set_ylabel(label)
    canvas.axes[-1].set_xlabel("sliding distance (µm); means dashed")


def _scatter(canvas: Canvas, data: Data) -> None:
    axes = canvas.add_subplot()
    x = _values(data, "sigma_e (um)")
    names = ("scatter of A", "scatter of mu", "Eq. (10)")
    for k, name in enumerate(name for name in names if name in data):
        axes.plot(x, 100 * _values(data, name), label=_symbol(name), **look(k))
    for name, style in (("printed A", DASHED), ("printed mu", DOTTED)):
        if name in data:
            axes.axhline(100 * float(data[name]), color=INK, linestyle=style, label=_symbol(name))
    axes.set(xlabel=SIGMA, ylabel="standard deviation / mean (%)")
    axes.set_ylim(bottom=0)
    below(canvas, axes)


def _symbol(name: str) -> str:
    return name.replace("mu", "$\\mu$")


REPRODUCTION = (
    Figure(
        "reproduction/table3-[amp]*",
        ("sigma_e (um)", "mesh", "printed", "ours", "u 95 %"),
        _table3,
        "{title}: this code over the printed value; bars are u (95 %), beyond which a difference counts.",
    ),
    Figure(
        "reproduction/fig4-correlation*",
        ("surface map", "ball map", "side (mm)"),
        maps(
            {"surface map": "(a) half-space", "ball map": "(b) ball"}, side="side (mm)", unit="height / rms"
        ),
        "Fig. 4: one realisation of both surfaces, normalised.",
        7.2,
    ),
    Figure(
        "reproduction/fig5-*",
        ("x (mm)", "pressure (MPa)", "pressure across (MPa)", "traction (MPa)", "traction across (MPa)"),
        _fig5,
        "Fig. 5: normal and tangential stress of the smooth sliding sphere, P = 70 N; below, normal stress "
        "less that of Hertz, and tangential stress less Coulomb's.",
        8.0,
        _fig5_differences,
    ),
    *(
        Figure(
            f"reproduction/fig6{panel}*",
            ("r/a0", "p/p0", "low", "high", "Hertz p/p0", "Greenwood-Tripp p/p0", "mu = 4 p/p0"),
            _fig6,
            f"Fig. 6({panel}): effective pressure of the frictionless rough contact on rings of equal area, "
            f"sigma_e = {rms} um.",
            4.0,
        )
        for panel, rms in (("a", "0.068"), ("b", "0.511"), ("c", "2.69"))
    ),
    Figure(
        "reproduction/fig6d",
        ("pressure map", "side (mm)", "Hertz radius (mm)"),
        _fig6d,
        "Fig. 6(d): contact pressure and the Hertz circle (dashed).",
        3.6,
    ),
    Figure(
        "reproduction/fig7*",
        ("x (mm)", "flat before (um)", "flat deformed (um)", "flat deformed, frictionless (um)"),
        _fig7,
        "Fig. 7: section of ball and half-space before contact and in contact; the lower panel carries the "
        "claim: by how much friction moves the half-space, in nm.",
        8.0,
        _fig7_difference,
    ),
    Figure(
        "reproduction/fig8-*",
        ("sigma_e (um)", "psi", "sigma_e of rates (um)", *(f"mu, {load}" for load in LOADS)),
        _fig8,
        "Fig. 8: friction, contact area and their rates of change; bars are 95 % intervals. Points without "
        "one are of the smooth contact, which has no scatter.",
        8.6,
    ),
    Figure(
        "reproduction/fig9*",
        ("distance (um)", "direction (deg)", "Q (N)"),
        _fig9,
        "Fig. 9: transverse (binormal) force Q over sliding distance and direction, P = 70 N.",
    ),
    Figure(
        "reproduction/fig10-*",
        ("direction (deg)",),
        _fig10,
        "Fig. 10: elastic part of friction, and friction, over the direction of sliding; one realisation.",
        6.4,
    ),
    Figure(
        "reproduction/fig11-*",
        tuple(f"{panel}: density" for panel in FIG11),
        _fig11,
        "Fig. 11: heights and slopes within the nominal contact before, and in true contact; means over "
        "realisations with 95 % intervals.",
        10.5,
        _fig11_gaussians,
    ),
    Figure(
        "reproduction/steady-sliding*",
        ("offset (um)", "mu", "A (mm^2)", "elastic friction (N)", "Q (N)"),
        _traces,
        "Traces of a slide: friction, contact area, elastic friction and Q over the distance.",
        7.2,
    ),
    Figure(
        "reproduction/section8-scatter*",
        ("sigma_e (um)", "scatter of A", "scatter of mu"),
        _scatter,
        "{title}: standard deviation over the mean.",
    ),
)
