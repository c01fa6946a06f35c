"""`rough-friction solve`: one scene, solved, with how well it converged."""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from verification.cli.output import (
    Parsers,
    StatusLine,
    add_json,
    check_outputs,
    columns,
    emit,
    emit_early,
    files_of,
    output_file,
    wrapped,
)

if TYPE_CHECKING:
    from refimpl import Solution

EPILOG = """examples:
  rough-friction solve table1-smooth
  rough-friction solve scene.toml --grid 512 --json result.json --plot result.png --vtk result.vtu
  rough-friction solve hertz --grid 48 --method dense
  rough-friction solve scene.toml --accuracy 0.01
  rough-friction solve scene.toml --grid 256x128 --size 2e-3x1e-3
  rough-friction solve scene.toml --budget
  rough-friction solve scene.toml --approach 1.2e-6
  rough-friction solve table1-smooth --accuracy 0.01 --explain

exit status: 0 CONVERGED, or CYCLED: converged, with an alternating contact edge, certified too, and
error bars include what that leaves open; 1 any other status, and with --strict a number that is not
usable (its bar exceeds half of it, that of Q half of the tangential force); 2 bad input;
130 interrupted, after the table of a refinement's last finished grid

Shipped scenes: hertz, metal-polymer, rough-planes, table1-rough, table1-smooth.
"""

DEFAULT_GRID = 256
FILES = ("plot", "vtk", "npz", "netcdf", "patches")
# Options of refimpl, which --help does not wait for.
METHODS = ("fft", "dense", "paper")
ACCURATE = ("friction_coefficient", "contact_area", "contact_area_corrected", "max_pressure")

# Options with the names of `refimpl.solve`, and the switches of terms among them.
PASSED_ON = ("grid", "accuracy", "quantity", "method", "approach", "tolerance")
LIMITS = ("max_grid", "max_seconds", "max_memory")
SWITCHES = ("coupled", "oblique", "tilted", "slope_correction", "plastic")

# Advice after an end that is no success.
NEXT = {
    "STAGNATED": "not converged: a residual below stays above the tolerance; check units first "
    "(E, tau, lengths), then try a looser --tolerance or a coarser --grid",
    "ITERATION_LIMIT": "not converged within the limits of iterations: a looser --tolerance or --accuracy",
    "ACCURACY_NOT_REACHED": "the certificate holds, the accuracy was not reached: a larger --accuracy, or "
    "more of --max-grid, --max-seconds, --max-memory",
    "NO_CONTACT": "nothing touches: prescribe a larger --approach, or leave it out to press with the load",
}

# attribute of Solution, name in the table, factor from SI to the unit shown, that unit
QUANTITIES = (
    ("friction_coefficient", "friction coefficient mu", 1.0, ""),
    ("contact_area", "contact area A", 1e6, "mm^2"),
    ("contact_area_corrected", "A, perimeter-corrected", 1e6, "mm^2"),
    ("max_pressure", "maximum pressure p_max", 1e-6, "MPa"),
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
    add = parser.add_argument
    add("scene", metavar="SCENE", help="a scene's TOML file, or the name of a shipped scene")
    size = parser.add_mutually_exclusive_group().add_argument
    size(
        "--grid",
        metavar="N",
        type=elements,
        help=f"N elements along the longer side, or both numbers, 128x64 (default {DEFAULT_GRID})",
    )
    add("--max-grid", metavar="N", type=int, help="with --accuracy: at most N elements along the longer side")
    add("--max-seconds", metavar="S", type=float, help="with --accuracy: at most so many seconds in all")
    add("--max-memory", metavar="GB", type=_gigabytes, help="with --accuracy: at most so many GB for a grid")
    size("--accuracy", metavar="A", type=float, help="refine until the error bar is this share of mu")
    add(
        "--quantity",
        metavar="Q",
        choices=ACCURATE,
        help=f"what --accuracy is about: {', '.join(ACCURATE)} (default mu; without friction, A)",
    )
    add(
        "--method",
        choices=METHODS,
        default="fft",
        help="production solver (default), plain reference for small grids, or the paper's scheme",
    )
    add("--size", metavar="LXxLY", type=lengths, help="lengths of the domain (m), in place of the scene's")
    add("--approach", metavar="D", type=float, help="prescribe the approach (m) instead of the load")
    add(
        "--oblique",
        action=argparse.BooleanOptionalAction,
        default=None,
        help="include or exclude every slope term (default: the scene decides)",
    )
    add(
        "--coupled",
        action=argparse.BooleanOptionalAction,
        default=None,
        help="include or exclude normal-tangential coupling (default: the scene decides)",
    )
    add(
        "--tilted",
        action=argparse.BooleanOptionalAction,
        default=None,
        help="include or exclude the slope change by shear (default: the scene decides)",
    )
    add("--slope-correction", action="store_true", help="exact tractions of oblique facets in Eq. (7)")
    add(
        "--plastic",
        metavar="on|off",
        type=_on_or_off,
        help="end pressures at the hardness, or never (default: the scene's own, or where they reach it)",
    )
    add("--explain", action="store_true", help="print what the scene requires, without solving it")
    add("--tolerance", metavar="T", type=float, help="for the certificate (default 1e-8; paper 1e-4)")
    add(
        "--budget",
        action="store_true",
        help="uncertainty budget and derivatives (under a load, a file with [tolerances] has it in any case)",
    )
    add("--strict", action="store_true", help="exit status 1 too where a number of the table is not usable")
    add("--plot", metavar="FILE", type=output_file, help="maps and profiles (.png, .svg or .pdf)")
    add("--vtk", metavar="FILE.vtu", type=output_file, help="both deformed surfaces, for ParaView")
    add("--npz", metavar="FILE.npz", type=output_file, help="fields with coordinates and units, for numpy")
    add("--netcdf", metavar="FILE.nc", type=output_file, help="the same as NetCDF, for xarray")
    add("--patches", metavar="FILE.csv", type=output_file, help="table of contact patches as CSV")
    add_json(parser)
    parser.set_defaults(run=run)


def _gigabytes(text: str) -> float:
    """Argument type of a memory: GB, returned in bytes.

    >>> _gigabytes("1.5")
    1500000000.0
    """
    try:
        return 1e9 * float(text)
    except ValueError as wrong:
        raise argparse.ArgumentTypeError(f"expected a number of GB, not {text!r}") from wrong


def _on_or_off(text: str) -> bool:
    if text not in ("on", "off"):
        raise argparse.ArgumentTypeError(f"{text}: expected on or off")
    return text == "on"


def elements(text: str) -> int | tuple[int, int]:
    """Argument type of a grid: a number, or two.

    >>> elements("128"), elements("128x64")
    (128, (128, 64))
    """
    try:
        numbers = [int(number) for number in text.split("x")]
    except ValueError:
        numbers = []
    if len(numbers) not in (1, 2):
        raise argparse.ArgumentTypeError(f"expected a number of elements, or two like 128x64, not {text!r}")
    return numbers[0] if len(numbers) == 1 else (numbers[0], numbers[1])


def lengths(text: str) -> tuple[float, float]:
    """Argument type of a size: two lengths (m).

    >>> lengths("83e-6x204e-6")
    (8.3e-05, 0.000204)
    """
    try:
        x, y = (float(length) for length in text.split("x"))
    except ValueError as wrong:
        raise argparse.ArgumentTypeError(f"expected two lengths in m like 2e-3x1e-3, not {text!r}") from wrong
    return x, y


def run(options: argparse.Namespace) -> int:
    """Solve and show; status 1 when the certificate does not meet the tolerance, or nothing touches."""
    import refimpl
    from refimpl.driver.limits import Limits
    from refimpl.driver.options import Options
    from refimpl.driver.refined import forecast
    from refimpl.errors import InputError
    from refimpl.planning.terms import RequestedTerms
    from refimpl.scene.discretise import Discretiser
    from refimpl.scene.scene_file import read_tolerances
    from verification.cli import arrays, explain, plot, plot_style, vtk
    from verification.cli import budget as budget_lines

    _refuse_ignored(options)
    plot_style.check_suffix(options.plot)
    vtk.check_suffix(options.vtk)
    arrays.check(options.npz, options.netcdf)
    scene = refimpl.read_scene(options.scene)
    if options.size is not None:
        scene = replace(scene, side=None, size=options.size)
    inputs = [Path(options.scene), *files_of(scene)]
    outputs = {name: getattr(options, name) for name in ("json", *FILES)}
    check_outputs(inputs, **outputs)
    if options.grid is None and options.accuracy is None:
        options.grid = DEFAULT_GRID
    keywords = {name: getattr(options, name) for name in PASSED_ON}
    switches = {name: getattr(options, name) for name in SWITCHES}
    most = {name: getattr(options, name) for name in LIMITS}
    checked = Options(scene=scene, requested=RequestedTerms(**switches), limits=Limits(**most), **keywords)
    if options.explain:
        discretiser = Discretiser(scene, checked.approach)
        plan = checked.plan(discretiser)
        expected = None if checked.accuracy is None else forecast(checked, plan, discretiser)
        found = explain.document(checked, plan, options.scene, expected)
        emit(found, options.json, explain.explained(checked, plan, options.scene, expected))
        return 0
    if options.budget and options.approach is not None:
        raise InputError(
            "--approach", options.approach, "none with --budget, which is about the scene's load"
        )
    tolerances = read_tolerances(options.scene)
    line = StatusLine()
    try:
        solution = refimpl.solve(scene, **keywords, **switches, **most, progress=line.show)
    except KeyboardInterrupt as interrupt:
        line.close()
        show_finished(interrupt, options.scene)
        raise
    finally:
        line.close()
    if options.plot is not None:
        plot.draw(solution, scene, options.plot)
    if options.vtk is not None:
        vtk.write(solution, options.vtk)
    if options.npz is not None:
        arrays.write_npz(solution, options.npz)
    if options.netcdf is not None:
        arrays.write_netcdf(solution, options.netcdf)
    if options.patches is not None:
        arrays.write_patches(solution, options.patches)
    found, text = document(solution, options.scene), table(solution, options.scene)
    if tolerances or options.budget:
        found["budget"] = None
        if reason := budget_lines.hindrance(solution, options.approach):
            text += f"\n\n{wrapped(reason, 'no uncertainty budget: ')}"
        else:
            emit_early(found, options.json, text)  # an interrupt of the budget costs no solution
            budgets = budget_lines.made(scene, solution, tolerances)
            found["budget"] = plain(budget_lines.document(budgets))
            text = f"\n{budget_lines.table(budgets)}"
    emit(found, options.json, text)
    if options.strict and found["not_usable"]:
        return 1
    return 0 if solution.converged else 1


def _refuse_ignored(options: argparse.Namespace) -> None:
    """Refuse an option that the others leave without a meaning, rather than ignore it."""
    from refimpl.errors import InputError

    if options.quantity is not None and options.accuracy is None:
        raise InputError("--quantity", options.quantity, "none without --accuracy, which it is about")
    for name in (*FILES, "budget", "strict") if options.explain else ():
        if value := getattr(options, name):
            shown = str(value) if isinstance(value, Path) else value
            raise InputError(f"--{name}", shown, "none with --explain, which does not solve the scene")


def show_finished(interrupt: KeyboardInterrupt, scene: str) -> None:
    """Show the table of the last finished grid: the `Solution` that is the interrupt's argument, if any."""
    from refimpl import Solution
    from verification.cli.output import show

    finished = [item for item in interrupt.args if isinstance(item, Solution)]
    if finished:
        show(f"interrupted; the last finished grid:\n\n{table(finished[0], scene)}")


def document(solution: Solution, scene: str) -> dict[str, object]:
    """The JSON of a solve: SI units and the names of `refimpl.Solution`; arrays are for the VTK file."""
    from verification.framework.provenance import provenance

    summary = {key: plain(value) for key, value in solution.summary().items()}
    return {"scene": scene, **summary, "not_usable": not_usable(solution), "provenance": provenance()}


def table(solution: Solution, scene: str) -> str:
    """Return the numbers, how well they converged, the terms not modelled, and the warnings."""
    found = [_row(solution, *quantity) for quantity in QUANTITIES]
    if solution.plan.includes("plastic"):
        name = f"plastic area, {solution.plastic_share:.1%} of A"
        found.insert(3, _row(solution, "plastic_area", name, 1e6, "mm^2"))
    summary = solution.summary()
    certificate = [[name.replace("_", " "), f"{value:.2g}"] for name, value in summary["certificate"].items()]
    not_modelled = [
        [term["term"], term["reason"], _change(term["effect"])]
        for term in summary["plan"]
        if not term["included"]
    ]
    parts = [
        f"{scene}: {solution.grid} elements, method {summary['method']}, {summary['cost']['seconds']:.2f} s\n"
        + wrapped(NEXT.get(solution.status.name, ""), f"status: {solution.status.name}  "),
        columns(found),
        f"certificate, each residual within {solution.tolerance:g} (0 is exact):\n{columns(certificate)}",
        f"not modelled:\n{columns(not_modelled)}" if not_modelled else "",
        *(_warned(warning) for warning in summary["warnings"]),
    ]
    return "\n\n".join(part for part in parts if part)


def error_bar(solution: Solution, quantity: str) -> float:
    """The sum of the parts of a number's uncertainty, in its unit; 0 where none is stated."""
    return math.fsum(solution.uncertainty.get(quantity, {}).values())


def not_usable(solution: Solution) -> list[str]:
    """Return the names of the numbers in the table whose bar exceeds half of their magnitude."""
    shown = [attribute for attribute, *_ in QUANTITIES]
    if solution.plan.includes("plastic"):
        shown.append("plastic_area")
    return [name for name in shown if _verdict(solution, name)]


def _verdict(solution: Solution, quantity: str) -> str:
    """Return "(not usable)" or nothing. Symmetry may make Q zero: its magnitude is that of the
    tangential force, F and Q together. Without friction that of F and Q is N, and that of mu is 1.
    """
    from refimpl.accuracy.digits import verdict

    value = getattr(solution, quantity)
    if not math.isfinite(value):  # without contact
        return ""
    scale = {"binormal_force": math.hypot(solution.friction_force, solution.binormal_force)}
    if not solution.traction.any():  # frictionless
        scale = dict.fromkeys(("friction_force", "binormal_force"), solution.normal_force)
        scale["friction_coefficient"] = 1.0
    return verdict(error_bar(solution, quantity), scale.get(quantity, value))


def _row(solution: Solution, quantity: str, name: str, factor: float, unit: str) -> list[str]:
    """Return a row of the table: value and bar with the digits that the bar leaves, and the verdict."""
    from refimpl.accuracy.digits import bar_of, digits_of

    error = error_bar(solution, quantity) * factor
    value = digits_of(getattr(solution, quantity) * factor, error)
    return [name, value, f"{bar_of(error)} {_verdict(solution, quantity)}".rstrip(), unit]


def _change(effect: Mapping[str, float]) -> str:
    """Return the effect of neglecting a term, in words; nothing where it is exactly zero."""
    if not any(effect.values()):
        return ""
    return f"estimated change of mu {effect['friction']:.1e}, of A {effect['area']:.1e}"


def _warned(warning: Mapping[str, object]) -> str:
    return wrapped(str(warning["text"]), f"warning ({warning['name']}): ")


def plain(item: object) -> object:
    """NaN and infinity, which JSON does not have, as None.

    >>> plain({"a": [1.0, float("nan")]})
    {'a': [1.0, None]}
    """
    if isinstance(item, Mapping):
        return {key: plain(value) for key, value in item.items()}
    if isinstance(item, list | tuple):
        return [plain(value) for value in item]
    return None if isinstance(item, float) and not math.isfinite(item) else item
