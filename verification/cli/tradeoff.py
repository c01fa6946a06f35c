"""`rough-friction tradeoff`: what an error costs, over method, grid, tolerance and neglected terms."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from verification.cli.output import Parsers, add_json, check_outputs, columns, emit, files_of

EPILOG = """examples:
  rough-friction tradeoff table1-smooth --grids 32,64,128,256 --reference 1024
  rough-friction tradeoff table1-rough --grids 64,128,256,512 --reference 2048 --json tradeoff.json

Times are processor seconds of this machine; run it with little else going on. Every way is solved
N times for its least time, and once more for its memory.
"""


def add_parser(commands: Parsers) -> None:
    """Declare the subcommand."""
    parser = commands.add_parser(
        "tradeoff",
        help="the cost-accuracy table: cost of an error in mu, A or p_max",
        description="Solve one scene in every way and on every grid, and list what an error costs.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("scene", metavar="SCENE", help="a TOML file, or the name of a shipped scene")
    parser.add_argument("--grids", metavar="M,M,...", type=_grids, default=[32, 64, 128, 256])
    parser.add_argument("--reference", metavar="M", type=int, default=1024, help="grid of the reference")
    parser.add_argument("--repeats", metavar="N", type=int, default=2)
    add_json(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Run the study and print the cost-accuracy table."""
    from refimpl.errors import InputError
    from refimpl.scene.scene_file import read_scene
    from verification.framework.case import jsonable
    from verification.framework.files import Progress
    from verification.tradeoff.settings import inapplicable, settings
    from verification.tradeoff.study import TOLERANCES, study

    if options.reference < 2 * max(options.grids) or options.reference % 2:
        allowed = f"an even grid of at least twice the finest one, {2 * max(options.grids)}"
        raise InputError("--reference", options.reference, allowed)
    if options.repeats < 1:
        raise InputError("--repeats", options.repeats, "at least one")
    scene = read_scene(options.scene)
    check_outputs([Path(options.scene), *files_of(scene)], json=options.json)
    progress = Progress(len(settings(options.grids, TOLERANCES, inapplicable(scene))))
    try:
        found = study(scene, options.scene, options.grids, options.reference, options.repeats, progress.tick)
    finally:
        progress.close()
    emit(jsonable(found), options.json, _table(found))
    return 0


def _grids(text: str) -> list[int]:
    try:
        grids = sorted({int(part) for part in text.split(",")})
    except ValueError as alien:
        raise argparse.ArgumentTypeError(f"{text!r} is no list of grids like 64,128") from alien
    if grids[0] < 4:
        raise argparse.ArgumentTypeError(f"{text!r} has a grid of fewer than 4 elements a side")
    return grids


def _table(found: dict[str, Any]) -> str:
    rows = [["quantity", "error", "cheapest way", "grid", "seconds", "convolutions"]]
    for row in found["prices"]:
        offer = [
            row["way"] or "none of those tried",
            *(_short(row[key]) for key in ("M", "seconds", "convolutions")),
        ]
        rows.append([row["quantity"], f"{row['error']:.1%}", *offer])
    parts = [columns(rows)]
    for why in ("left out", "failed"):
        if found[why]:
            parts.append(f"{why}:\n" + columns([list(item) for item in found[why].items()]))
    return "\n\n".join(parts)


def _short(value: float | None) -> str:
    return "-" if value is None else f"{value:.3g}"
