"""`rough-friction inspect`: what a surface's file holds, its roughness parameters, a fit and a picture."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from verification.cli.output import (
    Parsers,
    StatusLine,
    add_json,
    check_outputs,
    columns,
    emit,
    output_file,
    wrapped,
)

if TYPE_CHECKING:
    from refimpl import Inspection

EPILOG = """examples:
  rough-friction inspect surface.x3p --plot surface.png
  rough-friction inspect heights.csv --unit um --pixel-size 1.5e-6,1.5e-6 --level sphere
  rough-friction inspect surface.sur --low-pass 2.5e-6 --fit self-affine

--fit prints a surface for a scene file, with standard deviations; another seed is another specimen.
"""
SCALES = ((1.0, "m"), (1e-3, "mm"), (1e-6, "um"), (1e-9, "nm"), (0.0, "pm"))


def add_parser(commands: Parsers) -> None:
    """Declare the subcommand."""
    parser = commands.add_parser(
        "inspect",
        help="a surface file: points, units, orientation, roughness parameters, picture",
        description="Read a file of heights as a scene would, and print what it holds and how rough it is.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("file", metavar="FILE", help="an instrument's file, .npy, .csv, .txt, .xyz ...")
    parser.add_argument("--unit", help="of the heights: m, mm, um, nm, A or pm")
    parser.add_argument("--pixel-size", metavar="DX[,DY]", type=_pair, help="edges of a pixel (m)")
    parser.add_argument("--channel", type=_channel, help="name or number; by default the first of heights")
    parser.add_argument(
        "--level",
        type=_level,
        help="plane (default), none, mean, paraboloid, cylinder, sphere, or a polynomial's degree",
    )
    parser.add_argument(
        "--outliers", metavar="K", type=float, help="drop points K spreads off their neighbours"
    )
    parser.add_argument("--low-pass", metavar="L", type=float, help="damp wavelengths below L (m)")
    parser.add_argument("--high-pass", metavar="L", type=float, help="damp wavelengths above L (m)")
    parser.add_argument("--centre", metavar="X,Y", type=_pair, help="middle of the window (m); needs --size")
    parser.add_argument("--size", metavar="LX[,LY]", type=_pair, help="edges of the window (m)")
    parser.add_argument(
        "--fit", choices=("gaussian", "self-affine"), help="fit a random surface, print it as TOML"
    )
    parser.add_argument(
        "--plot", metavar="FILE", type=output_file, help="map, autocorrelation, spectrum as PNG"
    )
    add_json(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Inspect the file."""
    from refimpl import inspect
    from verification.cli.plot_style import check_suffix

    check_suffix(options.plot)
    check_outputs([Path(options.file)], plot=options.plot, json=options.json)
    names = ("unit", "pixel_size", "channel", "level", "outliers", "low_pass", "high_pass", "centre")
    keys = {name: value for name in names if (value := getattr(options, name)) is not None}
    line = StatusLine()
    try:
        line.show(f"{options.file}: reading")
        found = inspect(options.file, size=options.size, **keys)
        document, text = found.document(), table(found)
        if options.fit:
            line.show(f"{options.file}: fitting")
            fit = found.fit(options.fit)
            document["fit"] = {"table": fit.table(), "deviations": fit.deviations, "notes": list(fit.notes)}
            text += f"\n\n{fit.toml()}".rstrip()
        if options.plot is not None:
            from verification.cli.plot_surface import draw_inspection

            draw_inspection(found, options.plot)
    finally:
        line.close()
    emit(_finite(document), options.json, text)
    return 0


def table(found: Inspection) -> str:
    """The file and its parameters, in the units of the object."""
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
        [name, _shown(doc["parameters"][name], unit), what] for name, (what, unit) in PARAMETERS.items()
    ]
    parts = [f"{doc['file']}\n" + columns([row for row in rows if row[1]]), columns(numbers)]
    return "\n\n".join(parts + [wrapped(note, "note: ") for note in doc["notes"]])


def _shown(value: float, unit: str) -> str:
    if not math.isfinite(value):
        return "-"
    return _length(value) if unit == "m" else f"{value:.4g} {unit}".rstrip()


def _length(value: float) -> str:
    """A length at the scale of the object."""
    factor, unit = next(pair for pair in SCALES if abs(value) >= pair[0])
    return f"{value / (factor or 1e-12):.4g} {unit}"


def _both(pair: list[float]) -> str:
    return f"{_length(pair[0])} x {_length(pair[1])}"


def _finite(value: Any) -> Any:
    """The document with null for what is not a number."""
    if isinstance(value, dict):
        return {key: _finite(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [_finite(entry) for entry in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _pair(text: str) -> tuple[float, float]:
    try:
        numbers = [float(word) for word in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in (1, 2):
        raise argparse.ArgumentTypeError(f"expected a length in m, or two with a comma between, not {text!r}")
    return numbers[0], numbers[-1]


def _channel(text: str) -> str | int:
    return int(text) if text.isdecimal() else text


def _level(text: str) -> str | int:
    return int(text) if text.isdecimal() else text
