"""`rough-friction remake`: make committed results again that are older than the code they judge."""

from __future__ import annotations

import argparse
import os
import re
import shlex
import subprocess
import sys
import time
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from importlib import resources
from pathlib import Path

from reports.result_files import read_result, read_results, result_paths, write_result
from verification.cli.output import Parsers, add_json, columns, emit
from verification.framework.provenance import ROOT

CUT = "cut from a whole run"
GOOD = ("made", CUT)
LOG = "remade"
"""Result file with what was made again."""
EPILOG = """examples:
  rough-friction remake --list
  rough-friction remake --seconds 3600
  rough-friction remake --only reproduction --only table2
  rough-friction remake --from full.json

A command that is interrupted, fails or takes too long leaves the committed file as it was; studies
that resume go on from out/remake the next time.
"""
_ENTRY = "from verification.start import run; raise SystemExit(run())"
_ROW = re.compile(r"^\| `(\w+)\.json` \| `([^`]*\bFILE\b[^`]*)`", flags=re.M)


@dataclass(frozen=True)
class Recipe:
    """Recipe of a committed file: a command with FILE for its name, and estimated seconds."""

    name: str
    command: str
    seconds: float | None


@dataclass(frozen=True)
class Remade:
    """One command that was run: its seconds and how it ended."""

    file: str
    seconds: float
    ended: str
    command: str


def add_parser(commands: Parsers) -> None:
    """Declare the subcommand."""
    parser = commands.add_parser(
        "remake",
        help="make stale committed results again",
        description="Make the committed results again that are older than the code, cheapest first,\n"
        "and write what was run to reports/results/remade.json and reports/RESULTS.md anew.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "--list", action="store_true", help="list stale files, commands and seconds; run nothing"
    )
    parser.add_argument(
        "--seconds", metavar="S", type=float, default=float("inf"), help="time for all commands"
    )
    parser.add_argument(
        "--only", metavar="NAME", action="append", help="this file, stale or not; may be repeated"
    )
    parser.add_argument(
        "--from",
        dest="whole",
        metavar="RUN",
        type=Path,
        help="run nothing: cut the files of its cases from a result file of `verify --tier full`",
    )
    add_json(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """List, or make again; status 1 where a command failed or a stale file is left."""
    from refimpl.errors import InputError

    if not options.seconds > 0:
        raise InputError("--seconds", options.seconds, "a positive number of seconds")
    folder = Path(str(resources.files("reports").joinpath("results")))
    known = recipes(folder)
    for name in options.only or ():
        if name not in known:
            raise InputError("--only", name, f"one of {', '.join(sorted(known))}")
    if options.whole is not None:
        done = list(cut(options.whole, known, options.only, folder))
        return _reported(done, options, folder)
    due = wanted(folder, known, options.only)
    if options.list:
        by_hand = [] if options.only else stale_by_hand(folder, known)
        rows = [[r.name, "n/a" if r.seconds is None else f"{r.seconds:.0f} s", r.command] for r in due]
        rows += [[name, "by hand", "several commands: see reports/results/README.md"] for name in by_hand]
        emit([asdict(r) for r in due], options.json, columns(rows, indent="") if rows else "nothing is stale")
        return int(bool(due))
    return _reported(list(remade(due, folder, options.seconds)), options, folder)


def _reported(done: Sequence[Remade], options: argparse.Namespace, folder: Path) -> int:
    """Record what was made, print a line a file, and return the exit status."""
    record(done, folder)
    rows = [[entry.file, f"{entry.seconds:.0f} s", entry.ended] for entry in done]
    emit(
        [asdict(entry) for entry in done],
        options.json,
        columns(rows, indent="") if rows else "nothing is stale",
    )
    return int(any(entry.ended not in GOOD for entry in done))


def recipes(folder: Path) -> dict[str, Recipe]:
    """Recipes by name: those of ``commands.toml``, else the first command in the file's row of "
    "``README.md``."""
    told = tomllib.loads((folder / "commands.toml").read_text(encoding="utf-8"))
    found = {
        name: Recipe(name, command, None)
        for name, command in _ROW.findall((folder / "README.md").read_text(encoding="utf-8"))
    }
    for name, entry in told.items():
        command = entry.get("command", found[name].command if name in found else "")
        found[name] = Recipe(name, command, entry.get("seconds"))
    return {name: recipe for name, recipe in found.items() if recipe.command}


def cut(
    whole: Path, known: Mapping[str, Recipe], only: Sequence[str] | None, folder: Path
) -> Iterator[Remade]:
    """Write the files whose cases a whole run holds; raises InputError for a file that is no such run."""
    from verification.cli.parts_of_a_run import parts, read_run

    commands = {name: recipe.command for name, recipe in known.items() if not only or name in only}
    for name, found in parts(read_run(whole), commands):
        write_result(found, folder / f"{name}.json")
        bad = found["counts"]["fail"] + found["counts"]["error"]
        yield Remade(name, found["seconds"], f"{CUT}; {bad} did not pass" if bad else CUT, commands[name])


def wanted(folder: Path, known: Mapping[str, Recipe], only: Sequence[str] | None) -> list[Recipe]:
    """Recipes of the named files, or of the stale and the unknown; the quick run last, then by seconds."""
    from verification.cli.stale import ages

    names = only or [age.name for age in ages(read_results(folder)) if age.state in ("stale", "unknown")]
    found = [known[name] for name in dict.fromkeys(names) if name in known]
    return sorted(found, key=lambda r: (r.name == "quick", r.seconds is None, r.seconds or 0.0))


def stale_by_hand(folder: Path, known: Mapping[str, Recipe]) -> list[str]:
    """Names of stale files that no single command makes."""
    from verification.cli.stale import ages

    return [age.name for age in ages(read_results(folder)) if age.state == "stale" and age.name not in known]


def remade(due: Sequence[Recipe], folder: Path, seconds: float) -> Iterator[Remade]:
    """Run the commands one after the other while there is time; a file is replaced only by a whole new "
    "one."""
    end = time.monotonic() + seconds
    work = ROOT / "out" / "remake"
    work.mkdir(parents=True, exist_ok=True)
    for recipe in due:
        left = end - time.monotonic()
        if left <= 0 or (recipe.seconds is not None and recipe.seconds > left):
            yield Remade(recipe.name, 0.0, "no time left", recipe.command)
            continue
        print(f"remake: {recipe.name}: {recipe.command}", file=sys.stderr, flush=True)
        start = time.monotonic()
        ended = _made(recipe, folder, work, None if left == float("inf") else left)
        entry = Remade(recipe.name, round(time.monotonic() - start, 1), ended, recipe.command)
        record([entry], folder)
        yield entry


def _made(recipe: Recipe, folder: Path, work: Path, left: float | None) -> str:
    """Run one command; "made", or why not."""
    target = work / f"{recipe.name}.json"
    old = target.stat().st_mtime_ns if target.exists() else None
    own_log = str(work / f"{recipe.name}.jsonl")
    words = [word.replace("FILE", str(target)) for word in shlex.split(recipe.command)]
    words = [own_log if word == "mutation.jsonl" else word for word in words]
    if words[0] == "rough-friction":
        words = [sys.executable, "-c", _ENTRY, *words[1:]]
    elif words[0] == "python":
        words[0] = sys.executable
    elif words[0] == "pytest":
        words = [sys.executable, "-m", "pytest", *words[1:]]
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    with (work / f"{recipe.name}.log").open("w", encoding="utf-8") as log:
        try:
            status = subprocess.run(
                words, cwd=ROOT, env=environment, stdout=log, stderr=log, timeout=left, check=False
            ).returncode
        except subprocess.TimeoutExpired:
            return "time ran out"
        except OSError as refused:
            return f"did not start: {refused.strerror}"
    if status not in (0, 1):  # 1: made, with checks that did not pass
        return f"exit status {status}; see {target.with_suffix('.log')}"
    if not target.exists() or target.stat().st_mtime_ns == old:
        return "wrote no file"
    try:
        write_result(read_result(target), folder / target.name)
    except (OSError, ValueError) as broken:
        return f"no result file: {broken}"
    return "made" if status == 0 else "made; exit status 1"


def record(done: Sequence[Remade], folder: Path) -> None:
    """Add what was run to the log, one row a file, and write the page of results again."""
    from reports import results_page

    path = folder / f"{LOG}.json"
    before = read_result(path) if path in result_paths(folder) else {"rows": []}
    rows = {row[0]: row for row in before["rows"]}
    for entry in done:
        if entry.ended != "no time left":
            rows[f"{entry.file}.json"] = [f"{entry.file}.json", entry.seconds, entry.ended, entry.command]
    if rows:
        stamp = datetime.now(UTC).isoformat(timespec="seconds")
        write_result({"study": "results made again", "date": stamp, "rows": list(rows.values())}, path)
        results_page.main()
