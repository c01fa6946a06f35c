"""Log of a study of faults, from which the study resumes: a line of JSON for each fault.

Each record has the digest of the code that made it. Records of other code are not read: a fault may have been
changed under the same name, and the problems too.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, TypeVar

Record = dict[str, Any]
Fault = TypeVar("Fault", str, int)
"""Name of a fault of the table, or seed of a random one."""


def resumed(
    log: Path, faults: Iterable[Fault], tried: Callable[[Fault], Mapping[str, Any]], code: str
) -> Iterator[Record]:
    """Return the records of the faults: those that the log has of this code, the others tried and added."""
    lines = log.read_text(encoding="utf-8").splitlines() if log.exists() else []
    known = {each["fault"]: each for each in map(json.loads, lines) if each.get("code") == code}
    for fault in faults:
        if fault not in known:
            known[fault] = {"fault": fault, **tried(fault), "code": code}
            with log.open("a", encoding="utf-8") as file:
                file.write(json.dumps(known[fault]) + "\n")
        yield known[fault]
