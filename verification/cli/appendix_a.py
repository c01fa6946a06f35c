"""`rough-friction appendix-a`: the plane problems behind the paper's Appendix A."""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from verification.cli import appendix_tables, half_space
from verification.cli.options import Options, Parsers, declare, number, numbers, option, subcommand
from verification.cli.output import check_workers, emit, refusal
from verification.output.files import Progress
from verification.output.text_table import columns

# A table is of a slope's square, so none of zero; half a period of positions is all, the rest is its mirror.
MAP_RANGES = {
    "slopes-deg": (0.1, 45.0, "degrees"),
    "wavelengths": (4.0, 1e4, "half-widths"),
    "positions": (0.0, 0.5, "wavelengths"),
}
FACE_SLACK_DEG = 1e-11  # 90 - gamma rounds; `appendix_a.wedge` allows for more
NARROW = "a smaller slope angle in degrees: so narrow a wedge has no bound on its cost at these r"
AXIS_OPTIONS = {"slope_deg": "slopes-deg", "wavelength": "wavelengths", "position": "positions"}
MAP_AXES = ("slope_deg", "wavelength", "position", "offset")

WAVE = "--slope-deg 6.5 --wavelength 100 --position 0.25 --nu 0.3 --offsets=-3,3"
EXAMPLES = {
    "strip": WAVE,
    "wedge": "--gamma-deg 10 --r 0.25,0.5,2 --theta-deg 0,30 --json -",
    "fem": WAVE,
    "surface": "table1-rough --grid 64",
    "map": "--slopes-deg 2.5,5,10,15 --wavelengths 16,32,64,128 \\\n    --positions 0,0.5 --json map.json",
    "look-up": "--slope-deg 6.5 --wavelength 64 --position 0.25 --nu 0.3",
    "element": "--slope-deg 6.5 --nu 0.3 --E 118e9 --upper-nu 0.3 --upper-E 200e9",
}

WAVE_OPTIONS: Options = appendix_tables.LOOK_UP_OPTIONS | {
    "--offsets": option("distances from the centre, in half-widths", type=numbers, required=True),
}
WEDGE_OPTIONS: Options = {
    "--gamma-deg": option("slope angle of the faces (degrees)", type=number, required=True),
    "--r": option("distances from the tip", type=numbers, required=True),
    "--theta-deg": option("angles from the bisector (degrees)", type=numbers, required=True),
    "--half-width": option("pressed length of each face (default 1)", type=number, default=1.0),
}
MAP_OPTIONS: Options = {
    "--slopes-deg": option("maximum slopes (degrees)", type=numbers),
    "--wavelengths": option("in half-widths of the strip", type=numbers),
    "--positions": option("of the strip's centre: crest 0 to valley 0.5", type=numbers),
    "--jobs": option("worker processes (default 2)", metavar="N", type=int, default=2),
}

GROUPS = {
    "look-up": appendix_tables.PAIR,
    "element": appendix_tables.PAIR,
    "surface": half_space.SURFACE_FILE,
}
"""Title, text and options of a further group of a problem's options."""


def add_parser(commands: Parsers) -> None:
    """Declare the subcommand and its own subcommands."""
    parser = commands.add_parser(
        "appendix-a",
        help="the plane problems of Appendix A",
        description="The plane problems of Appendix A: pressure on wavy boundaries and wedges.",
        epilog=_epilog("fem", "wedge"),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    problems = parser.add_subparsers(title="problems", metavar="PROBLEM", required=True)
    for name, run, options, text in (
        ("strip", strip, WAVE_OPTIONS, "pressed strip on a sinusoidal boundary, to first order"),
        ("wedge", wedge, WEDGE_OPTIONS, "stresses of a wedge pressed on both faces near its tip"),
        ("fem", fem, WAVE_OPTIONS, "pressed strip on a sinusoidal boundary, by finite elements"),
        ("map", coefficient_map, MAP_OPTIONS,
         "error of flat influence coefficients on sinusoidal waves, as a table; minutes"),
        ("look-up", appendix_tables.look_up, appendix_tables.LOOK_UP_OPTIONS,
         "error of flat coefficients in the plane, from the shipped map"),
        ("element", appendix_tables.element, appendix_tables.ELEMENT_OPTIONS,
         "error of flat coefficients of a square element in three dimensions, from the shipped table"),
        ("surface", half_space.surface, half_space.OPTIONS,
         "how far a half-space may be trusted on one's own surface; two further solves"),
    ):  # fmt: skip
        about = text.capitalize() + "."
        made = subcommand(problems, name, run, options, help=text, description=about, epilog=_epilog(name))
        if name in GROUPS:
            title, body, rows = GROUPS[name]
            declare(made.add_argument_group(title, body), rows)


def _epilog(*names: str) -> str:
    lines = [
        f"  rough-friction appendix-a {name} {EXAMPLES[name]}".replace(" --nu", " \\\n    --nu")
        for name in names
    ]
    return "\n".join(["examples:", *lines])


def strip(options: argparse.Namespace) -> int:
    """Print the displacements of a wavy boundary, correct to first order in its slope, and of a flat one."""
    from appendix_a.strip import first_order

    with _by_option():
        wavy, flat = first_order(*_wave(options), offsets=options.offsets)
    note = appendix_tables.first_order_note(*_wave(options))
    document = {
        "offsets": options.offsets, "wavy": wavy.tolist(), "flat": flat.tolist(), "caution": note,
    }  # fmt: skip
    scope = "to first order in the slope" + (f"\n{note}" if note else "")
    emit(document, options.json, _displacements(document, scope))
    return 0


def fem(options: argparse.Namespace) -> int:
    """Print the displacements of a wavy boundary and of a flat one."""
    from appendix_a.fem.sinusoid import SOLVES, fem_json, sinusoid

    with _by_option(), Progress(SOLVES) as line:
        found = sinusoid(
            *_wave(options), offsets=options.offsets, progress=lambda *_: line.tick("finite elements")
        )
    document = fem_json(found)
    remark = f"discretisation error {document['discretisation_error']:.1g}"
    emit(document, options.json, _displacements(document, remark))
    return 0


def coefficient_map(options: argparse.Namespace) -> int:
    """Write the versioned table of the error of flat coefficients, every Poisson ratio in it."""
    from appendix_a.fem.coefficient_map import check_complete
    from appendix_a.fem.map2d import POSITIONS, SLOPES_DEG, WAVELENGTHS, compute

    check_workers("--jobs", options.jobs)
    axes = {
        "slopes-deg": tuple(options.slopes_deg or SLOPES_DEG),
        "wavelengths": tuple(options.wavelengths or WAVELENGTHS),
        "positions": tuple(options.positions or POSITIONS),
    }
    for name, (low, high, unit) in MAP_RANGES.items():
        for value in axes[name]:
            if not low <= value <= high:
                raise refusal(f"--{name}", value, f"{low:g} to {high:g} {unit}")
    with _by_option(**{field: (name, axes[name], "") for field, name in AXIS_OPTIONS.items()}):
        check_complete(*axes.values())
    pairs = len(axes["slopes-deg"]) * len(axes["wavelengths"])
    with _by_option(), Progress(pairs) as line:
        found = compute(
            *axes.values(),
            workers=options.jobs,
            progress=lambda *_: line.tick("slopes and wavelengths"),
        )
    rows = [[axis.replace("_", " "), " ".join(f"{x:g}" for x in getattr(found, axis))] for axis in MAP_AXES]
    error = f"stated error, percentage points: {found.error_percentage_points.max():.2g}"
    emit(found.document(), options.json, f"{columns(rows, indent='')}\n{error}")
    return 0


def _wave(options: argparse.Namespace) -> tuple[float, float, float, float]:
    return options.slope_deg, options.wavelength, options.position, options.nu


def _displacements(document: Mapping[str, Any], remark: str) -> str:
    series = zip(document["offsets"], document["wavy"], document["flat"], strict=True)
    rows = [
        [f"{x:g}", f"{wavy:.6f}", f"{flat:.6f}", f"{100 * (wavy - flat) / flat:+.3f}" if flat else "-"]
        for x, wavy, flat in series
    ]
    table = columns([["offset", "wavy", "flat", "wavy over flat (%)"], *rows], indent="")
    return f"{table}\n\nin units of p a / E, relative to the centre; {remark}"


def wedge(options: argparse.Namespace) -> int:
    """Print the stresses at each pair of `--r` and `--theta-deg`, over the pressure, tension positive."""
    import numpy as np

    from appendix_a.wedge import stresses

    _refuse_angles(options)
    r, degrees = (a.ravel() for a in np.meshgrid(options.r, options.theta_deg, indexing="ij"))
    with _by_option(gamma=("gamma_deg", options.gamma_deg, NARROW)):
        found = stresses(r, np.radians(degrees), math.radians(options.gamma_deg), options.half_width)
    names = ("r", "theta_deg", "sigma_r", "sigma_theta", "tau_rtheta")
    series = dict(zip(names, (r, degrees, *found), strict=True))
    rows = [[f"{number:.9g}" for number in row] for row in zip(*series.values(), strict=True)]
    document = {"gamma_deg": options.gamma_deg, "half_width": options.half_width,
                **{name: values.tolist() for name, values in series.items()}}  # fmt: skip
    emit(document, options.json, columns([list(names), *rows], indent=""))
    return 0


def _refuse_angles(options: argparse.Namespace) -> None:
    """Refuse in degrees, as typed, what `appendix_a.wedge` would refuse in radians."""
    if not 0 <= options.gamma_deg < 90:
        raise refusal("--gamma-deg", options.gamma_deg, "a slope angle of 0 to below 90 degrees")
    face = 90 - options.gamma_deg
    for theta in options.theta_deg:
        if abs(theta) > face + FACE_SLACK_DEG:
            raise refusal("--theta-deg", theta, f"angles within the faces at +-{face:g} degrees")


@contextmanager
def _by_option(**other: tuple[str, object, str]) -> Iterator[None]:
    """Make refusals of `appendix_a` name the option; ``other``: name, value and bounds by field."""
    from appendix_a.errors import InputError

    try:
        yield
    except InputError as refused:
        value = refused.value.tolist() if hasattr(refused.value, "tolist") else refused.value
        name, value, allowed = other.get(refused.field, (refused.field, value, ""))
        allowed = allowed or refused.allowed
        raise InputError(f"--{name.replace('_', '-')}", value, allowed) from refused
