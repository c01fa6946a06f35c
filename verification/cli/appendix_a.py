"""`rough-friction appendix-a`: the plane problems behind the paper's Appendix A."""

from __future__ import annotations

import argparse
from collections.abc import Callable

from verification.cli.output import Parsers, add_json, columns, emit

EPILOG = """examples:
  rough-friction appendix-a fem --slope-deg 6.5 --wavelength 100 --position 0.25 --nu 0.3 --offsets=-3,3
  rough-friction appendix-a wedge --gamma-deg 10 --r 0.25,0.5,2 --theta-deg 0,30 --json -

A list that starts with a minus sign needs the equals sign: --offsets=-3,3
"""


def add_parser(commands: Parsers) -> None:
    """Declare the subcommand and its own subcommands."""
    parser = commands.add_parser(
        "appendix-a",
        help="the plane problems of Appendix A",
        description="The plane problems of Appendix A: pressure on wavy boundaries and wedges.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    problems = parser.add_subparsers(title="problems", metavar="PROBLEM", required=True)
    _add_fem(problems)
    _add_wedge(problems)


def numbers(text: str) -> list[float]:
    """Argument type: numbers with commas between them.

    >>> numbers("-10,3.5")
    [-10.0, 3.5]
    """
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a list of numbers like -3,0,3") from None


def _add_fem(problems: Parsers) -> None:
    parser = _problem(problems, "fem", fem, "pressed strip on a sinusoidal boundary, by finite elements")
    parser.add_argument(
        "--slope-deg", type=float, required=True, help="maximum slope of the profile (degrees)"
    )
    parser.add_argument("--wavelength", type=float, required=True, help="in half-widths of the strip")
    parser.add_argument("--position", type=float, required=True, help="crest 0, flank 0.25, valley 0.5")
    parser.add_argument("--nu", type=float, required=True, help="Poisson's ratio")
    parser.add_argument(
        "--offsets",
        type=numbers,
        required=True,
        help="distances from the strip's centre, in half-widths",
    )


def _add_wedge(problems: Parsers) -> None:
    parser = _problem(problems, "wedge", wedge, "stresses of a wedge pressed on both faces near its tip")
    parser.add_argument(
        "--gamma-deg", type=float, required=True, help="slope angle of the faces (degrees)"
    )
    parser.add_argument("--r", type=numbers, required=True, help="distances from the tip")
    parser.add_argument(
        "--theta-deg", type=numbers, required=True, help="angles from the bisector (degrees)"
    )
    parser.add_argument(
        "--half-width", type=float, default=1.0, help="pressed length of each face (default 1)"
    )


def _problem(
    problems: Parsers, name: str, run: Callable[[argparse.Namespace], int], text: str
) -> argparse.ArgumentParser:
    parser = problems.add_parser(name, help=text, description=text.capitalize() + ".")
    add_json(parser)
    parser.set_defaults(run=run)
    return parser


def fem(options: argparse.Namespace) -> int:
    """Displacements of a wavy boundary and of a flat one, in units of p a / E."""
    from appendix_a.fem.sinusoid import sinusoid

    found = sinusoid(
        options.slope_deg, options.wavelength, options.position, options.nu, offsets=options.offsets
    )
    document = {
        "offsets": found.offsets.tolist(),
        "wavy": found.wavy.tolist(),
        "flat": found.flat.tolist(),
        "discretisation_error": found.discretisation_error,
    }
    rows = [
        [f"{x:g}", f"{w:.6f}", f"{f:.6f}"]
        for x, w, f in zip(found.offsets, found.wavy, found.flat, strict=True)
    ]
    table = columns([["offset", "wavy", "flat"], *rows], indent="")
    emit(
        document,
        options.json,
        f"{table}\n\nin units of p a / E; discretisation error {found.discretisation_error:.1g}",
    )
    return 0


def wedge(options: argparse.Namespace) -> int:
    """Stresses at every pair of `--r` and `--theta-deg`, in units of the face pressure, tension positive."""
    import numpy as np

    from appendix_a.wedge import stresses

    r, degrees = (a.ravel() for a in np.meshgrid(options.r, options.theta_deg, indexing="ij"))
    found = stresses(r, np.radians(degrees), float(np.radians(options.gamma_deg)), options.half_width)
    names = ("r", "theta_deg", "sigma_r", "sigma_theta", "tau_rtheta")
    series = dict(zip(names, (r, degrees, *found), strict=True))
    rows = [[f"{number:.9g}" for number in row] for row in zip(*series.values(), strict=True)]
    document = {"gamma_deg": options.gamma_deg, "half_width": options.half_width,
                **{name: values.tolist() for name, values in series.items()}}  # fmt: skip
    emit(document, options.json, columns([list(names), *rows], indent=""))
    return 0
