"""`rough-friction inspect`: what a surface's file holds, its roughness parameters, a fit and a picture."""

from __future__ import annotations

import argparse
import math
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from verification.cli.options import (
    Options,
    name_or_number,
    one_or_two_lengths,
    option,
    picture,
    three_numbers,
)
from verification.cli.output import check_outputs, emit, refusal
from verification.output.files import StatusLine
from verification.output.text_table import columns, wrapped

if TYPE_CHECKING:
    from refimpl import Inspection

EPILOG = """examples:
  rough-friction inspect surface.x3p --plot surface.png
  rough-friction inspect heights.csv --unit um --pixel-size 1.5e-6,1.5e-6 --level sphere
  rough-friction inspect surface.sur --low-pass 2.5e-6 --fit self-affine

--fit prints a surface for a scene file, with standard deviations; another seed is another specimen.
"""
KEYS = (
    "unit", "pixel_size", "channel", "level", "outliers", "scan_lines", "low_pass", "high_pass", "centre",
)  # fmt: skip

OPTIONS: Options = {
    "file": option("an instrument's file, .npy, .csv, .txt, .xyz ...", metavar="FILE"),
    "--unit": option("of the heights: m, mm, um, nm, A or pm"),
    "--pixel-size": option("edges of a pixel (m)", metavar="DX[,DY]", type=one_or_two_lengths),
    "--channel": option("name or number; by default the first of heights", type=name_or_number),
    "--level": option(
        "plane (default), none, mean, paraboloid, cylinder, sphere, or a polynomial's degree",
        type=name_or_number,
    ),
    "--outliers": option("drop points K spreads off their neighbours", metavar="K", type=float),
    "--scan-lines": option("level each line along this axis", choices=("x", "y")),
    "--low-pass": option("damp wavelengths below L (m)", metavar="L", type=float),
    "--high-pass": option("damp wavelengths above L (m)", metavar="L", type=float),
    "--centre": option("middle of the window (m); needs --size", metavar="X,Y", type=one_or_two_lengths),
    "--size": option("edges of the window (m)", metavar="LX[,LY]", type=one_or_two_lengths),
    "--with": option(
        "area and mean pressure by Persson and by Greenwood and Williamson, of a body of this modulus (Pa) "
        "and Poisson's ratio under a rigid flat with this load (N)",
        metavar="E,NU,LOAD",
        type=three_numbers,
    ),
    "--fit": option("fit a random surface, print it as TOML", choices=("gaussian", "self-affine")),
    "--plot": option("map, autocorrelation, spectrum as PNG", metavar="FILE", type=picture),
}


def run(options: argparse.Namespace) -> int:
    """Inspect the file."""
    from refimpl import inspect_surface

    check_outputs([Path(options.file)], plot=options.plot, json=options.json)
    keys = {name: value for name in KEYS if (value := getattr(options, name)) is not None}
    with StatusLine() as line:
        line.show(f"{options.file}: reading")
        found = inspect_surface(options.file, size=options.size, **keys)
        document, text = found.document(), table(found)
        if pressed := getattr(options, "with"):
            document["theories"], shown = _theories(found, *pressed)
            text += f"\n\n{shown}"
        if options.fit:
            line.show(f"{options.file}: fitting")
            fit = found.fit(options.fit)
            document["fit"] = {
                "table": fit.table(),
                "deviations": fit.deviations,
                "misfit": fit.misfit,
                "notes": list(fit.notes),
            }
            text += f"\n\n{fit.toml()}".rstrip()
        if options.plot is not None:
            from verification.cli.plot_surface import draw_inspection

            draw_inspection(found, options.plot)
    emit(document, options.json, text)
    return 0


def _theories(found: Inspection, E: float, nu: float, load: float) -> tuple[list[dict[str, Any]], str]:
    """Return both theories for the levelled map under a rigid flat, as plain values and a table."""
    from refimpl import Material
    from refimpl.solution.rough_contact import Roughness, estimates

    if not load > 0:
        raise refusal("--with", load, "a positive load in N")
    material = Material(E=E, nu=nu)
    area = math.prod(n * edge for n, edge in zip(found.z.shape, found.pixel, strict=True))
    modulus = material.E / (1 - material.nu**2)
    pressed = estimates(load, area, Roughness.of(found.z, found.pixel), modulus)
    rows = [["theory (elastic)", "A/A0", "mean pressure"]]
    rows += [[e.theory, f"{e.area / area:.3g}", f"{e.mean_pressure / 1e6:.4g} MPa"] for e in pressed]
    return [asdict(estimate) for estimate in pressed], columns(rows)


def table(found: Inspection) -> str:
    """Return the file and its parameters, in the units of the object."""
    from refimpl.measured.inspection import PARAMETERS

    doc = found.document()
    nx, ny = doc["points"]
    others = [name for name in doc["channels"] if name != doc["channel"]]
    rows = [
        ["format", doc["format"]],
        ["channel", doc["channel"] + (f"; there are also {', '.join(others)}" if others else "")],
        ["points", f"{nx} x {ny}, {doc['missing']} missing"],
        ["pixel", _both(doc["pixel"])],
        ["size", _both(doc["size"])],
        ["unit", f"heights in {doc['unit']}"],
        ["orientation", doc["orientation"]],
        ["level", f"{doc['level']}, slopes {doc['slopes'][0]:.3g}, {doc['slopes'][1]:.3g}"
         + ("" if doc["radius"] is None else f", radius {_length(doc['radius'])}")],
        ["window", f"{doc['window']['points'][0]} x {doc['window']['points'][1]} points, "
         f"{doc['window']['missing']} missing"],
    ]  # fmt: skip
    numbers = [
        [name, _shown(doc["parameters"][name], unit, doc["deviations"].get(name)), what]
        for name, (what, unit) in PARAMETERS.items()
    ]
    parts = [f"{doc['file']}\n" + columns([row for row in rows if row[1]]), columns(numbers)]
    return "\n\n".join(parts + [wrapped(note, "note: ") for note in doc["notes"]])


def _shown(value: float, unit: str, deviation: float | None = None) -> str:
    from refimpl.accuracy.digits import digits_of

    if not math.isfinite(value):
        return "-"
    if deviation is not None:
        return f"{digits_of(value, deviation)} +- {deviation:.1g}"
    return _length(value) if unit == "m" else f"{value:.4g} {unit}".rstrip()


def _length(value: float) -> str:
    from refimpl.solution.units import unit_at_scale

    unit = unit_at_scale(value, "m")
    return f"{value / unit.size:.4g} {unit.name}"


def _both(pair: list[float]) -> str:
    return f"{_length(pair[0])} x {_length(pair[1])}"
