"""Agreement of a folder of reference data with its checksums, and with its problems solved anew here.

    python -m verification.solver_suite.reference.agreement DIR [NAME-GLOB ...]

Elsewhere arithmetic differs in the last digits: new pressures must lie within the sum of both proven bounds.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import numpy as np

from refimpl.errors import InputError
from refimpl.grid import Array
from verification.output.result_files import parsed
from verification.solver_suite.protocol import ContactProblem, Coupling
from verification.solver_suite.reference.certified import CONTACT, NotCertified, certified
from verification.solver_suite.reference.files import FORMAT, INDEX, SUMS, checksums


def index_of(folder: Path) -> dict[str, Any]:
    """Read the index. Raises `InputError` for a folder without one of this format."""
    try:
        index: Any = parsed((folder / INDEX).read_text(encoding="utf-8"))
    except (OSError, ValueError) as broken:
        raise InputError("DIR", str(folder), f"a folder of reference data ({broken})") from broken
    if not isinstance(index, dict) or index.get("format") != FORMAT:
        raise InputError("DIR", str(folder), f"an index whose format is {FORMAT!r}")
    return dict(index)


def problem_of(folder: Path, entry: Mapping[str, Any]) -> ContactProblem:
    """Return the problem of an entry of the index."""
    p = entry["problem"]
    (nx, ny), (lx, ly) = p["shape"], p["lengths"]
    gap = array_of(folder, entry, "gap")
    dx, dy = lx / nx, ly / ny
    coupling = Coupling(p["tau"], p["beta"], p["shear_compliance"], p["sliding_direction"])
    return ContactProblem(
        gap,
        dx,
        p["reduced_modulus"],
        spacing_y=None if abs(dy - dx) < 1e-9 * dx else dy,
        periodic=bool(p["periodic"]),
        coupling=coupling if p["friction"] else None,
        hardness=p["hardness"] or None,
        **{p["control"]: p["value"]},
    )


def array_of(folder: Path, entry: Mapping[str, Any], what: str) -> Array:
    """Read ``gap`` or ``pressure`` of an entry, shape ``(nx, ny)``."""
    return np.fromfile(folder / entry["files"][what], "<f8").reshape(entry["problem"]["shape"])


def disagreements(folder: Path, globs: Sequence[str] = ()) -> Iterator[str]:
    """Yield what differs: checksums, then the problems whose names match ``globs``, solved from the files."""
    index = index_of(folder)
    lines = (folder / SUMS).read_text(encoding="utf-8").splitlines()
    stated = {name: digest for digest, _, name in (line.partition("  ") for line in lines)}
    found = checksums(folder)
    for name in sorted(stated.keys() | found.keys()):
        if stated.get(name) != found.get(name):
            yield f"{name}: its checksum is not the one in {SUMS}"
    chosen = [e for e in index["problems"] if not globs or any(fnmatchcase(e["name"], g) for g in globs)]
    if not chosen:
        raise InputError("NAME-GLOB", list(globs), "names of problems in the index")
    for entry in chosen:
        yield from (f"{entry['name']}: {what}" for what in _differences(folder, entry))


def _differences(folder: Path, entry: Mapping[str, Any]) -> Iterator[str]:
    problem, answer = problem_of(folder, entry), entry["answer"]
    pressure = array_of(folder, entry, "pressure")
    try:
        new = certified(problem)
    except NotCertified as reason:
        yield str(reason)
        return
    for name, other, mine in (
        ("pressure", pressure, new.pressure),
        ("approach", answer["approach"], new.approach),
        ("load", answer["load"], new.load),
    ):
        allowed = answer["bounds"][name] + getattr(new.bounds, name)
        off = float(np.max(np.abs(np.subtract(other, mine))))
        if not off <= allowed:
            yield f"{name} differs by {off:.3g}, more than both bounds, {allowed:.3g}"
    codes = np.fromfile(folder / entry["files"]["contact"], np.uint8).reshape(pressure.shape)
    proven = (codes <= CONTACT) & (new.contact <= CONTACT)
    if (codes[proven] != new.contact[proven]).any():
        yield "contact proven on one side and separation on the other"


def main(arguments: Sequence[str] | None = None) -> int:
    """Print what differs; status 1 if anything does, 2 for a folder that cannot be read."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    if not words:
        print(
            "usage: python -m verification.solver_suite.reference.agreement DIR [NAME-GLOB ...]",
            file=sys.stderr,
        )
        return 2
    try:
        found = list(disagreements(Path(words[0]), words[1:]))
    except InputError as refused:
        print(refused, file=sys.stderr)
        return 2
    print("\n".join(found) if found else "checksums hold, and every problem agrees within the proven bounds")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
