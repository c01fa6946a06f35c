"""A campaign: many seeded inputs, each within its processor time, every outcome counted, every fault kept."""

from __future__ import annotations

import base64
import random
import tempfile
import time
import warnings
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

from verification.framework.provenance import provenance
from verification.fuzz.mutations import mutated
from verification.fuzz.targets import Target, targets
from verification.stress_tests.study import OutOfTime, processor_time

FORMAT = "rough-friction fuzzing, version 1"
SECONDS = 20.0  # processor time limit; the largest lattice of noise that a scene may request takes 5 s
KEPT = 20  # faults shown in full


def outcome(target: Target, content: bytes, folder: Path) -> str:
    """Outcome of an input: accepted, refused, hang, or the fault's type, place and text."""
    path = folder / f"input{target.suffix}"
    path.write_bytes(content)
    begun = time.process_time()
    ended = _ended(target, path)
    # A reader that takes every exception of a parser takes `OutOfTime` too.
    return "hang" if time.process_time() - begun >= SECONDS else ended


def _ended(target: Target, path: Path) -> str:
    try:
        with processor_time(SECONDS), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            target.read(path)
    except target.refusals:
        return "refused"
    except OutOfTime:
        return "hang"
    # The campaign is after exceptions that no reader should let out: any one is what was looked for.
    except Exception as fault:
        place = fault.__traceback__
        while place is not None and place.tb_next is not None:
            place = place.tb_next
        where = f"{Path(place.tb_frame.f_code.co_filename).name}:{place.tb_lineno}" if place else "?"
        return f"{type(fault).__name__} at {where}: {str(fault)[:120]}"
    return "accepted"


def campaign(
    inputs: int, seed: int = 2001, tick: Callable[[str], None] = lambda _: None
) -> dict[str, object]:
    """Run about ``inputs`` inputs, shared among the targets; the document of the log."""
    started = time.process_time()
    rows: list[dict[str, Any]] = []
    faults: list[dict[str, str]] = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for number, target in enumerate(targets()):
            source, counts = random.Random(1000 * seed + number), Counter[str]()
            begun, count = time.process_time(), -(-int(inputs * target.share * 1000) // 1000)
            for _ in range(count):
                content = mutated(source.choice(target.valid), target.valid, source)
                ended = outcome(target, content, folder)
                good = ended in ("accepted", "refused")
                counts[ended if good or ended == "hang" else "traceback"] += 1
                if not good and len(faults) < KEPT:
                    faults.append(
                        {"target": target.name, "fault": ended, "input": base64.b64encode(content).decode()}
                    )
            seconds = round(time.process_time() - begun, 2)
            kinds = {kind: counts[kind] for kind in ("accepted", "refused", "traceback", "hang")}
            rows.append({"target": target.name, "inputs": count, **kinds, "seconds": seconds})
            tick(target.name)
    return {
        "format": FORMAT,
        "seed": seed,
        "inputs": sum(row["inputs"] for row in rows),
        "tracebacks": sum(row["traceback"] for row in rows),
        "hangs": sum(row["hang"] for row in rows),
        "seconds": round(time.process_time() - started, 2),
        "targets": rows,
        "faults": faults,
        "provenance": provenance(),
    }
