"""`rough-friction solve`: one scene, solved, with how well it converged."""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import TYPE_CHECKING

from verification.cli.output import Parsers, add_json, columns, emit, output_file

if TYPE_CHECKING:
    from refimpl import Scene, Solution

EPILOG = """examples:
  rough-friction solve table1-smooth
  rough-friction solve scene.toml --grid 512 --json result.json --plot result.png --vtk result.vtu
  rough-friction solve hertz --grid 48 --method dense
  rough-friction solve scene.toml --accuracy 0.01
  rough-friction solve scene.toml --approach 1.2e-6

Shipped scenes: hertz, metal-polymer, rough-planes, table1-rough, table1-smooth.
"""

DEFAULT_GRID = 256

# attribute, name in the table, factor from SI, unit shown
QUANTITIES = (
    ("friction_coefficient", "friction coefficient mu", 1.0, ""),
    ("contact_area", "contact area A", 1e6, "mm^2"),
    ("contact_area_corrected", "A, perimeter-corrected", 1e6, "mm^2"),
    ("max_pressure", "largest pressure f_max", 1e-6, "MPa"),
    ("approach", "approach", 1e6, "um"),
    ("normal_force", "normal force N", 1.0, "N"),
    ("friction_force", "friction force F", 1.0, "N"),
    ("binormal_force", "binormal force Q", 1.0, "N"),
)


def add_parser(commands: Parsers) -> None:
    """Declare the subcommand."""
    parser = commands.add_parser(
        "solve",
        help="solve a scene",
        description="Solve a scene: friction, contact area, pressures, and how well it converged.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "scene", metavar="SCENE", help="a scene's TOML file, or the name of a shipped scene"
    )
    size = parser.add_mutually_exclusive_group()
    size.add_argument("--grid", metavar="N", type=int, help=f"N x N elements (default {DEFAULT_GRID})")
    size.add_argument(
        "--accuracy", metavar="A", type=float, help="refine until the results are this certain"
    )
    parser.add_argument("--method", choices=("fft", "dense"), default="fft", help="default fft")
    parser.add_argument(
        "--approach", metavar="D", type=float, help="prescribe the approach (m) instead of the load"
    )
    parser.add_argument(
        "--oblique",
        action=argparse.BooleanOptionalAction,
        default=None,
        help="keep or drop every slope term (default: the scene decides)",
    )
    parser.add_argument(
        "--tolerance", metavar="T", type=float, help="what the certificate must meet (default 1e-8)"
    )
    parser.add_argument(
        "--plot", metavar="FILE.png", type=output_file, help="maps and profiles as a picture"
    )
    parser.add_argument(
        "--vtk", metavar="FILE.vtu", type=output_file, help="both deformed surfaces for ParaView"
    )
    add_json(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Solve and show; status 1 when the certificate does not meet the tolerance."""
    import refimpl
    from verification.cli import plot, vtk

    plot.check_suffix(options.plot)
    vtk.check_suffix(options.vtk)
    scene = refimpl.read_scene(options.scene)
    grid = DEFAULT_GRID if options.grid is None and options.accuracy is None else options.grid
    chosen = {"tolerance": options.tolerance} if options.tolerance is not None else {}
    solution = refimpl.solve(
        scene,
        grid=grid,
        accuracy=options.accuracy,
        method=options.method,
        approach=options.approach,
        oblique=options.oblique,
        **chosen,
    )
    if options.plot is not None:
        plot.draw(solution, scene, options.plot)
    if options.vtk is not None:
        vtk.write(solution, options.vtk)
    emit(document(solution, scene, options), options.json, table(solution, options))
    return 0 if solution.status in (refimpl.Status.CONVERGED, refimpl.Status.CYCLED) else 1


def table(solution: Solution, options: argparse.Namespace) -> str:
    """What was found, how well it converged, what was left out, and the warnings."""
    size = f"{solution.grid.M} x {solution.grid.M}"
    found = [
        [name, f"{getattr(solution, attribute) * factor:.6g}", unit]
        for attribute, name, factor, unit in QUANTITIES
    ]
    certificate = [
        [field.name.replace("_", " "), f"{getattr(solution.certificate, field.name):.2g}"]
        for field in fields(solution.certificate)
    ]
    parts = [
        f"{options.scene}: {size} elements, method {options.method}",
        f"status: {solution.status.name}",
        columns(found),
        f"certificate (0 is exact):\n{columns(certificate)}",
        *(f"warning: {text}" for text in solution.warnings),
    ]
    return "\n\n".join(parts)


def document(solution: Solution, scene: Scene, options: argparse.Namespace) -> dict[str, object]:
    """The JSON of a solve: SI units, the names of `refimpl.Solution`; arrays are for the VTK file."""
    from verification.provenance import provenance

    numbers = {name: getattr(solution, name) for name, *_ in QUANTITIES}
    return {
        "scene": options.scene,
        "grid": solution.grid.M,
        "method": options.method,
        "load": scene.load,
        **numbers,
        "binormal_ratio": solution.binormal_force / solution.normal_force,
        "status": solution.status.name,
        "certificate": plain(solution.certificate),
        "uncertainty": plain(solution.uncertainty),
        "plan": plain(solution.plan),
        "warnings": list(solution.warnings),
        "cost": plain(solution.cost),
        "provenance": provenance(),
    }


def plain(item: object) -> object:
    """Dataclasses, enums and numpy numbers as JSON has them; NaN and infinity become None.

    >>> plain({"a": (1.0, float("nan"))})
    {'a': [1.0, None]}
    """
    if is_dataclass(item) and not isinstance(item, type):
        return {field.name: plain(getattr(item, field.name)) for field in fields(item)}
    if isinstance(item, Enum):
        return item.name
    if isinstance(item, Mapping):
        return {str(plain(key)): plain(value) for key, value in item.items()}
    if isinstance(item, list | tuple):
        return [plain(value) for value in item]
    if hasattr(item, "tolist"):
        return plain(item.tolist())
    if isinstance(item, float) and not math.isfinite(item):
        return None
    return item
