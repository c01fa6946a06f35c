"""`rough-friction tradeoff`: the grid and the seconds that an error costs, for one scene."""

from __future__ import annotations

import argparse
from pathlib import Path

from verification.cli.options import SCENE, Options, grids, option
from verification.cli.output import check_outputs, emit, files_of, refusal

EPILOG = """examples:
  rough-friction tradeoff table1-rough --grids 64,128,256 --reference 1024

Last column: the grid whose error bar is short enough, as solve --accuracy requests it and --explain
forecasts it. Column before: the grid whose error against the reference is.
"""
OPTIONS: Options = {
    "scene": SCENE,
    "--grids": option("default 32,64,128,256", metavar="M,M,...", type=grids, default=[32, 64, 128, 256]),
    "--reference": option("grid of the reference", metavar="M", type=int, default=1024),
}


def run(options: argparse.Namespace) -> int:
    """Solve all grids, the half of the reference's among them, and print the table."""
    from refimpl.scene.scene_file import read_scene
    from verification.benchmarks.cost_of_accuracy import costs, solve_grids, table
    from verification.framework.case import jsonable
    from verification.output.provenance import provenance

    if options.reference < 2 * max(options.grids) or options.reference % 2:
        allowed = f"an even grid of at least twice the finest one, {2 * max(options.grids)}"
        raise refusal("--reference", options.reference, allowed)
    scene = read_scene(options.scene)
    check_outputs([Path(options.scene), *files_of(scene)], json=options.json)
    rows = solve_grids(scene, sorted({*options.grids, options.reference // 2}), options.reference)
    found = {"scene": options.scene, "reference": options.reference, "grids": rows}
    found |= {"prices": costs([rows]), "shown": costs([rows], "bars")}
    shown = table([{"class": options.scene, **found}])
    emit(jsonable(found | {"provenance": provenance()}), options.json, shown)
    return 0
