"""`rough-friction solve`: one scene, solved, with how well it converged."""

from __future__ import annotations

import argparse
import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from verification.cli.options import (
    DEFAULT_GRID,
    Options,
    elements,
    file_of,
    gigabytes,
    lengths,
    on_or_off,
    option,
    output_file,
    picture,
)
from verification.cli.output import check_outputs, emit, files_of, refusal
from verification.cli.solve_table import document, not_usable, show_finished, table
from verification.output.files import StatusLine, is_stream
from verification.output.text_table import wrapped

if TYPE_CHECKING:
    from refimpl import Scene, Solution

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
error bars include the alternation; 1 any other status, and with --strict a number that is not
usable (its bar exceeds half of it, that of Q half of the tangential force); 2 bad input;
130 interrupted, after the table of a refinement's last finished grid

Shipped scenes: hertz, metal-polymer, rough-planes, table1-rough, table1-smooth.
"""

FILES = ("plot", "vtk", "npz", "netcdf", "patches")
# Options of refimpl, which --help does not wait for.
METHODS = ("fft", "dense", "paper")
ACCURATE = (
    "friction_coefficient_corrected",
    "friction_coefficient",
    "contact_area",
    "contact_area_corrected",
    "max_pressure",
)

# Options with the names of `refimpl.solve`, and the switches of terms among them.
PASSED_ON = ("grid", "accuracy", "quantity", "method", "approach", "tolerance")
LIMITS = ("max_grid", "max_seconds", "max_memory")
SWITCHES = ("coupled", "oblique", "tilted", "slope_correction", "plastic")


def _switch(terms: str) -> Mapping[str, Any]:
    text = f"include or exclude {terms} (default: the scene decides)"
    return option(text, action=argparse.BooleanOptionalAction, default=None)


ONE_OF = ("--grid", "--accuracy")
OPTIONS: Options = {
    "scene": option("a scene's TOML file, or the name of a shipped scene", metavar="SCENE"),
    "--grid": option(
        f"N elements along the longer side, or both numbers, 128x64 ({DEFAULT_GRID})",
        metavar="N",
        type=elements,
    ),
    "--max-grid": option("with --accuracy: at most N elements along the longer side", metavar="N", type=int),
    "--max-seconds": option("with --accuracy: at most so many seconds in all", metavar="S", type=float),
    "--max-memory": option("with --accuracy: at most so many GB in all", metavar="GB", type=gigabytes),
    "--accuracy": option("refine until the error bar is this share of mu", metavar="A", type=float),
    "--quantity": option(
        f"quantity whose bar --accuracy limits: {', '.join(ACCURATE)} (default mu; without friction, A)",
        metavar="Q",
        choices=ACCURATE,
    ),
    "--method": option(
        "production solver (default), plain reference for small grids, or the paper's scheme",
        choices=METHODS,
        default="fft",
    ),
    "--size": option("lengths of the domain (m), in place of the scene's", metavar="LXxLY", type=lengths),
    "--approach": option("prescribe the approach (m) instead of the load", metavar="D", type=float),
    "--oblique": _switch("every slope term"),
    "--coupled": _switch("normal-tangential coupling"),
    "--tilted": _switch("the slope change by shear"),
    "--slope-correction": option("exact tractions of oblique facets in Eq. (7)", action="store_true"),
    "--plastic": option(
        "cap pressures at the hardness, or never (default: the scene's own, or where they reach it)",
        metavar="on|off",
        type=on_or_off,
    ),
    "--explain": option(
        "print what the scene requires instead of solving it; with --accuracy small solves forecast the grid",
        action="store_true",
    ),
    "--tolerance": option("for the certificate (default 1e-8; paper 1e-4)", metavar="T", type=float),
    "--budget": option(
        "uncertainty budget and derivatives (under a load, a file with [tolerances] has it in any case)",
        action="store_true",
    ),
    "--strict": option("exit status 1 too where a number of the table is not usable", action="store_true"),
    "--plot": option("maps and profiles (.png, .svg or .pdf)", metavar="FILE", type=picture),
    "--vtk": option("both deformed surfaces, for ParaView", metavar="FILE.vtu", type=file_of(".vtk", ".vtu")),
    "--npz": option("fields with coordinates and units, for numpy", metavar="FILE.npz", type=file_of(".npz")),
    "--netcdf": option("the same as NetCDF, for xarray", metavar="FILE.nc", type=file_of(".nc")),
    "--patches": option("table of contact patches as CSV", metavar="FILE.csv", type=output_file),
}


def run(options: argparse.Namespace) -> int:
    """Solve and show; status 1 when the certificate does not meet the tolerance, or nothing touches."""
    import refimpl
    from refimpl.scene.scene_file import read_tolerances

    began = time.perf_counter()
    scene = _read_scene(options)
    keywords = {name: getattr(options, name) for name in (*PASSED_ON, *SWITCHES, *LIMITS)}
    if options.explain:
        return _explain(scene, options, keywords)
    if options.budget and options.approach is not None:
        raise refusal("--approach", options.approach, "none with --budget, which is about the scene's load")
    tolerances = read_tolerances(options.scene)
    try:
        with StatusLine() as line:
            solution = refimpl.solve(scene, **keywords, progress=line.show)
    except KeyboardInterrupt as interrupt:
        show_finished(interrupt, options.scene)
        raise
    _write_files(solution, scene, options)
    found = document(solution, options.scene) if options.json else {}
    text = table(solution, options.scene, waited=time.perf_counter() - began)
    if tolerances or options.budget:
        text = _with_budget(scene, solution, tolerances, options, found, text)
    unusable = not_usable(solution) if options.strict else []
    if unusable:
        text += f"\n\n--strict: not usable are {', '.join(unusable)}"
    emit(found, options.json, text)
    return int(not solution.converged or bool(unusable))


def _read_scene(options: argparse.Namespace) -> Scene:
    import refimpl
    from verification.cli.arrays import require_netcdf

    _refuse_ignored(options)
    require_netcdf(options.netcdf)
    scene = refimpl.read_scene(options.scene)
    if options.size is not None:
        scene = replace(scene, side=None, size=options.size)
    outputs = {name: getattr(options, name) for name in ("json", *FILES)}
    check_outputs([Path(options.scene), *files_of(scene)], **outputs)
    return scene


def _explain(scene: Scene, options: argparse.Namespace, keywords: Mapping[str, Any]) -> int:
    from refimpl.driver.limits import Limits
    from refimpl.driver.options import Options
    from refimpl.driver.refined import forecast
    from refimpl.model.problem import Terms
    from refimpl.scene.discretise import Discretiser
    from verification.cli import explain

    checked = Options(
        scene=scene,
        requested=Terms(**{name: keywords[name] for name in SWITCHES}),
        limits=Limits(**{name: keywords[name] for name in LIMITS}),
        **{name: keywords[name] for name in PASSED_ON},
    )
    discretiser = Discretiser(scene, checked.approach)
    plan = checked.plan(discretiser)
    expected = None if checked.accuracy is None else forecast(checked, plan, discretiser)
    found = explain.document(checked, plan, options.scene, expected)
    emit(found, options.json, explain.explained(checked, plan, options.scene, expected))
    return 0


def _write_files(solution: Solution, scene: Scene, options: argparse.Namespace) -> None:
    from verification.cli import arrays, plot

    if options.plot is not None:
        plot.draw(solution, scene, options.plot)
    for name, write in arrays.WRITERS.items():
        if (path := getattr(options, name)) is not None:
            write(solution, path)


def _with_budget(
    scene: Scene,
    solution: Solution,
    tolerances: Mapping[str, float],
    options: argparse.Namespace,
    found: dict[str, object],
    text: str,
) -> str:
    """Add the uncertainty budget to the document; return the text that is left to be shown."""
    from refimpl.sensitivities.budget import budget as budget_of
    from verification.cli import budget

    found["budget"] = None
    reason = "" if solution.details.certified else "the solution's certificate does not hold"
    if options.approach is not None:
        reason = "it is about the scene's load, and this is at a prescribed approach"
    if reason:
        return f"{text}\n\n{wrapped(reason, 'no uncertainty budget: ')}"
    if options.json != Path("-"):  # an interrupt of the budget costs no solution
        replaceable = options.json is not None and not is_stream(options.json)
        emit(found, options.json if replaceable else None, text)
    with StatusLine() as line:
        line.show("uncertainty budget: what every parameter changes")
        budgets = budget_of(scene, solution, tolerances)
    found["budget"] = budget.document(budgets)
    return f"\n{budget.table(budgets)}"


def _refuse_ignored(options: argparse.Namespace) -> None:
    if options.quantity is not None and options.accuracy is None:
        raise refusal("--quantity", options.quantity, "none without --accuracy, which it is about")
    for name in (*FILES, "budget", "strict") if options.explain else ():
        if value := getattr(options, name):
            shown = str(value) if isinstance(value, Path) else value
            raise refusal(f"--{name}", shown, "none with --explain, which does not solve the scene")
