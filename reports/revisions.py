"""Date and commit of each result file of the report."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from reports.evidence import Evidence
from reports.results import FORMAT

NOT_KNOWN = "n/a"


def revisions_of(evidence: Evidence) -> list[tuple[str, str, str]]:
    """File, date and commit of every result file of the report; the run first."""
    rows = [("this run", *_made(evidence.run.get("provenance")))]
    for name, file in sorted(evidence.files.items()):
        provenance = file.get("provenance") if file.get("format") == FORMAT else newest(file)
        rows.append((f"{name}.json", *_made(provenance)))
    return rows


def newest(document: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """Provenance of a study's document, or of its newest run; else the document, if it is dated."""
    listed = [entry for value in document.values() if isinstance(value, list) for entry in value]
    records = [
        item["provenance"]
        for item in (document, *listed)
        if isinstance(item, Mapping) and "provenance" in item
    ]
    return max(
        records, key=lambda record: str(record["date"]), default=document if "date" in document else None
    )


def _made(provenance: Mapping[str, Any] | None) -> tuple[str, str]:
    if provenance is None:
        return NOT_KNOWN, NOT_KNOWN
    commit = str(provenance.get("commit") or NOT_KNOWN)[:12]
    changed = " and uncommitted changes" if provenance.get("dirty") else ""
    return str(provenance.get("date"))[:10], f"{commit}{changed}"
