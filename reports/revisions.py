"""Which code each result file of the report is of: date, commit, and a digest of the solver."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from typing import Any

from reports.evidence import Evidence
from reports.results import FORMAT

NOT_KNOWN = "n/a"


def revisions_of(evidence: Evidence) -> list[tuple[str, str, str, str]]:
    """File, date, commit and revision of the solver of every result file of the report; the run first."""
    rows = [("this run", *_made(evidence.run.get("provenance")))]
    for name, file in sorted(evidence.files.items()):
        provenance = file.get("provenance") if file.get("format") == FORMAT else newest(file)
        rows.append((f"{name}.json", *_made(provenance)))
    return rows


def one_revision(rows: Sequence[tuple[str, str, str, str]]) -> str:
    """Return how many of the files have the solver of the run, which is the first row."""
    (_, _, _, now), *files = rows
    same = sum(revision == now != NOT_KNOWN for *_, revision in files)
    return (
        f"Solver: the first digits of a digest of refimpl but for refimpl/identification. {same} of "
        f"{len(files)} files have that of this run. Those of samples looked at once "
        "belong to the code of their commit."
    )


def solver_revision(sources: Mapping[str, str]) -> str:
    """Digest of the folders of code that a solve comes from, of the digests that a result records.

    A fit of tau and beta uses solves and changes none.
    """
    folders = sorted(f for f in sources if f.partition("/")[0] == "refimpl" and f != "refimpl/identification")
    text = "".join(f"{folder}={sources[folder]}" for folder in folders)
    return hashlib.sha256(text.encode()).hexdigest()[:8] if folders else NOT_KNOWN


def newest(document: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """Provenance of a study's document, or of the newest run in its list."""
    listed = [entry for value in document.values() if isinstance(value, list) for entry in value]
    records = [
        item["provenance"]
        for item in (document, *listed)
        if isinstance(item, Mapping) and "provenance" in item
    ]
    return max(records, key=lambda record: str(record["date"]), default=None)


def _made(provenance: Mapping[str, Any] | None) -> tuple[str, str, str]:
    if provenance is None:
        return NOT_KNOWN, NOT_KNOWN, NOT_KNOWN
    commit = str(provenance.get("commit") or NOT_KNOWN)[:12]
    changed = " and uncommitted changes" if provenance.get("dirty") else ""
    solver = solver_revision(provenance.get("sources") or {})
    return str(provenance.get("date"))[:10], f"{commit}{changed}", solver
