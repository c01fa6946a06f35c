"""Reference data as a folder: raw arrays, an index as JSON and as CSV, its schema, licence and checksums.

Equal versions of the software on one machine write equal bytes: no date, no path, no machine is recorded.
The data's version is the SHA-256 of the file of checksums, so that it names the content.
"""

from __future__ import annotations

import hashlib
import json
import shutil
import tempfile
from collections.abc import Iterable, Mapping
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from typing import Any

import numpy as np

from refimpl.errors import InputError
from verification.output.provenance import DISTRIBUTION, ROOT, versions
from verification.output.text_table import csv_text
from verification.solver_suite import suite
from verification.solver_suite.command import header_of
from verification.solver_suite.reference import certified
from verification.solver_suite.reference.certified import Certified

FORMAT = "rough-friction reference data, version 1"
HERE = Path(__file__).parent
SOFTWARE = ("python", DISTRIBUTION, "numpy", "scipy", "ducc0")
"""What the bytes depend on."""
CODES = (
    "separated, proven",
    "in contact, proven",
    "separated as exported, within the bounds of contact",
    "in contact as exported, within the bounds of separation",
)
COLUMNS = (
    "name", "nx", "ny", "lx", "ly", "reduced_modulus", "control", "value", "periodic", "friction", "tau",
    "beta", "shear_compliance", "sliding_direction", "hardness", "approach", "load", "bound_pressure",
    "bound_approach", "bound_load",
)  # fmt: skip
"""Columns of ``index.csv``; numbers of the answer after those of the problem."""
SUMS, INDEX, CITATION = "SHA256SUMS", "index.json", "CITATION.cff"


class Export:
    """A new folder of reference data, whole at once. `InputError` for a used path, or without a parent."""

    def __init__(self, folder: Path) -> None:
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise InputError("--export", str(folder), "a new or an empty directory")
        if not folder.absolute().parent.is_dir():
            raise InputError("--export", str(folder), "a directory whose parent directory exists")
        self.folder = folder
        try:
            self._draft = Path(tempfile.mkdtemp(dir=folder.absolute().parent, prefix=f".{folder.name[:40]}."))
        except OSError as refused:
            allowed = f"a directory that can be written ({refused.strerror})"
            raise InputError("--export", str(folder), allowed) from refused
        (self._draft / "data").mkdir()
        self._entries: list[dict[str, Any]] = []
        self._uncertified: list[dict[str, str]] = []

    def __enter__(self) -> Export:
        return self

    def __exit__(self, *_: object) -> None:
        shutil.rmtree(self._draft, ignore_errors=True)

    def add(self, name: str, case: str, found: Certified) -> None:
        """Write the arrays of a problem; row i along x, column j along y, little endian."""
        arrays = {
            "gap": (f"data/{name}.gap.f64", found.problem.gap.astype("<f8")),
            "pressure": (f"data/{name}.pressure.f64", found.pressure.astype("<f8")),
            "contact": (f"data/{name}.contact.u8", found.contact),
        }
        for path, array in arrays.values():
            (self._draft / path).write_bytes(np.ascontiguousarray(array).tobytes())
        files = {what: path for what, (path, _) in arrays.items()}
        self._entries.append({"name": name, "case": case, **_numbers(found), "files": files})

    def report_uncertified(self, name: str, reason: str) -> None:
        """Name a problem whose pressures could not be certified."""
        self._uncertified.append({"name": name, "reason": reason})

    def close(self) -> str:
        """Write what describes the data, put the folder in its place, and return the data's version."""
        index = {
            "format": FORMAT,
            "license": "MIT",
            "suite": suite.identity(),
            "software": {name: versions()[name] for name in SOFTWARE},
            "tolerance": certified.TOLERANCE,
            "contact_codes": list(CODES),
            "problems": self._entries,
            "not_certified": self._uncertified,
        }
        self._write(INDEX, json.dumps(index, indent=1, allow_nan=False) + "\n")
        self._write("index.csv", _table(self._entries))
        self._write("schema.json", (HERE / "schema.json").read_text(encoding="utf-8"))
        self._write("LICENSE", licence())
        self._write("README.md", _text("readme.md").format(problems=len(self._entries)))
        sums = checksums(self._draft)
        self._write(SUMS, "".join(f"{digest}  {name}\n" for name, digest in sums.items()))
        version = version_of(self._draft)
        names = {"software": versions()[DISTRIBUTION], "suite": suite.identity()["version"]}
        self._write(CITATION, _text("citation.cff").format(version=version, **names))
        self._draft.chmod(0o755)
        if self.folder.exists():
            self.folder.rmdir()
        self._draft.rename(self.folder.absolute())
        return version

    def _write(self, name: str, text: str) -> None:
        (self._draft / name).write_text(text, encoding="utf-8", newline="\n")


def _numbers(found: Certified) -> dict[str, Any]:
    header = header_of(found.problem)
    shown = ("shape", "lengths", *COLUMNS[5:15])
    residual = None if found.residual is None else {k: float(v) for k, v in found.residual._asdict().items()}
    answer = {
        "approach": float(found.approach),
        "load": float(found.load),
        "largest_pressure": float(found.pressure.max()),
        "elements_in_contact": int(np.count_nonzero(found.pressure > 0)),
        "elements_undecided": int(np.count_nonzero(found.contact > certified.CONTACT)),
        "bounds": {name: float(bound) for name, bound in vars(found.bounds).items()},
        "condition": found.condition,
        "residual": residual,
    }
    return {"problem": {name: np.asarray(header[name]).tolist() for name in shown}, "answer": answer}


def _table(entries: Iterable[Mapping[str, Any]]) -> str:
    rows: list[Iterable[object]] = [COLUMNS]
    for entry in entries:
        problem, answer = entry["problem"], entry["answer"]
        numbers = [*problem["shape"], *problem["lengths"], *(problem[name] for name in COLUMNS[5:15])]
        bounds = [answer["bounds"][name] for name in ("pressure", "approach", "load")]
        rows.append([entry["name"], *numbers, answer["approach"], answer["load"], *bounds])
    return csv_text(rows)


def checksums(folder: Path) -> dict[str, str]:
    """Return the SHA-256 of every file below a folder but the sums themselves and the citation, by name."""
    paths = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
    listed = (name for name in paths if name not in (SUMS, CITATION))
    return {name: hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in listed}


def version_of(folder: Path) -> str:
    """Return the data's version: ``sha256:`` and the SHA-256 of its file of checksums."""
    return "sha256:" + hashlib.sha256((folder / SUMS).read_bytes()).hexdigest()


def licence() -> str:
    """Return the text of the licence, of the checkout or of the installed package."""
    if (ROOT / "LICENSE").is_file():
        return (ROOT / "LICENSE").read_text(encoding="utf-8")
    try:
        text = distribution(DISTRIBUTION).read_text("licenses/LICENSE")
    except PackageNotFoundError:
        text = None
    if text is None:
        raise FileNotFoundError("the licence of rough-friction is not installed")
    return text


def _text(name: str) -> str:
    return (HERE / "texts" / name).read_text(encoding="utf-8")
