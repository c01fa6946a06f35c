"""A campaign of disturbed sweeps: every one must end with the table of an undisturbed one, byte for byte."""

from __future__ import annotations

import os
import random
import resource
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import ExitStack, closing
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from verification.chaos.cluster import ONE_THREAD, Cluster, cluster
from verification.framework.provenance import provenance
from verification.sweep.engine import sweep
from verification.sweep.export import to_csv
from verification.sweep.store import files_of
from verification.sweep.study_file import read_study

FORMAT = "rough-friction chaos, version 1"
REALISATIONS, GRIDS = 60, (12, 16)
STUDY = f'scene = "table1-rough"\nrealisations = {REALISATIONS}\n[vary]\ngrid = {list(GRIDS)}\n'
RUNS = REALISATIONS * len(GRIDS)
CLUSTERS = 0.3  # share of sweeps
FAULTS = ("worker", "parent", "scheduler", "copy", "link", "full disk")
DISK_BYTES = (40_000, 120_000)  # a file may grow to: above SQLite's shared memory, below the whole store
WAIT_SECONDS = 120.0
COMMAND = """import sys
from verification.cli import main
from verification.sweep import engine
engine.CONNECT_SECONDS, engine.PATIENCE_SECONDS = 10.0, 3.0
raise SystemExit(main())"""

Record = dict[str, Any]


@dataclass
class Disturbed:
    """One sweep in its folder, what disturbs it, and the store that goes on."""

    folder: Path
    source: random.Random
    on_cluster: bool
    store: Path
    log: list[Record] = field(default_factory=list)

    def start(self, address: str | None, disk: int | None = None) -> subprocess.Popen[str]:
        """The command; ``disk`` limits the size of its files (bytes)."""
        where = ["--scheduler", address] if address else ["--workers", "1"]
        files = ["--store", str(self.store), "--csv", str(self.folder / "table.csv")]
        return subprocess.Popen(
            [sys.executable, "-c", COMMAND, "sweep", str(self.folder / "study.toml"), *files, *where],
            env=os.environ | ONE_THREAD, text=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
            preexec_fn=None if disk is None else _limit(disk),
        )  # fmt: skip

    def disturb(self, fault: str) -> None:
        """One attempt that is disturbed when a random number of runs are kept."""
        with ExitStack() as stack:
            there = stack.enter_context(cluster(self.folder, 1)) if self.on_cluster else None
            if fault == "link":
                self._lead_elsewhere()
            disk = self.source.randint(*DISK_BYTES) if fault == "full disk" else None
            child = self.start(there.address if there else None, disk)
            wanted = min(RUNS - 1, kept(self.store) + self.source.randint(1, RUNS // 2))
            deadline = time.monotonic() + WAIT_SECONDS
            while child.poll() is None and kept(self.store) < wanted and time.monotonic() < deadline:
                time.sleep(0.005)
            copied = self._act(fault, child, there)
            _, err = child.communicate(timeout=WAIT_SECONDS)
        said = {"lines": err.count("\n"), "traceback": "Traceback" in err}
        ended = {"fault": fault, "status": child.returncode, **said}
        self.log.append({**ended, "kept": kept(self.store), "copied": copied})

    def _act(self, fault: str, child: subprocess.Popen[str], there: Cluster | None) -> bool:
        """Disturb the running command; whether its store was copied, and the copy is what goes on."""
        if fault == "worker":
            for pid in [w.pid for w in there.workers] if there else workers_of(child.pid)[:1]:
                _kill(pid)
        elif fault == "scheduler" and there:
            there.scheduler.kill()
        elif fault == "copy":
            copy = self.folder / f"copy{len(self.log)}.sqlite"
            for file, new in zip(files_of(self.store), files_of(copy), strict=True):
                if file.exists() and not file.name.endswith("-shm"):
                    shutil.copy(file, new)
            _kill(child.pid)
            if is_whole(copy):
                self.store = copy
                return True
        elif fault != "full disk":
            _kill(child.pid)
        return False

    def _lead_elsewhere(self) -> None:
        """From now on a link to the store is what is swept."""
        link = self.folder / f"link{len(self.log)}.sqlite"
        link.symlink_to(os.path.realpath(self.store))
        self.store = link

    def finish(self) -> str:
        """The table after an undisturbed attempt, in this process."""
        study = read_study(self.folder / "study.toml")
        return to_csv(sweep(study, self.store, workers=0).rows)


def campaign(
    sweeps: int,
    seed: int,
    tick: Callable[[str], None] = lambda _: None,
    save: Callable[[Record], None] = lambda _: None,
) -> Record:
    """Run so many sweeps; the document of the log, which is saved after every fifth."""
    started = time.perf_counter()
    rows: list[Record] = []
    with tempfile.TemporaryDirectory() as name:
        expected = undisturbed(Path(name))
        for number in range(sweeps):
            folder = Path(name) / str(number)
            folder.mkdir()
            rows.append(_one(folder, random.Random(1000 * seed + number), expected))
            shutil.rmtree(folder)
            tick(f"{number} {'equal' if rows[-1]['equal'] else 'DIFFERENT'}")
            if len(rows) % 5 == 0:
                save(_document(rows, seed, time.perf_counter() - started))
    return _document(rows, seed, time.perf_counter() - started)


def _document(rows: list[Record], seed: int, seconds: float) -> Record:
    return {
        "format": FORMAT,
        "seed": seed,
        "study": STUDY,
        "sweeps": len(rows),
        "on a cluster": sum(row["cluster"] for row in rows),
        "faults": {f: sum(a["fault"] == f for row in rows for a in row["attempts"]) for f in FAULTS},
        "different": sum(not row["equal"] for row in rows),
        "tracebacks": sum(a["traceback"] for row in rows for a in row["attempts"]),
        "seconds": round(seconds, 1),
        "rows": rows,
        "provenance": provenance(),
    }


def undisturbed(folder: Path) -> str:
    """The table of the study, whose file is left in the folder."""
    (folder / "study.toml").write_text(STUDY)
    return to_csv(sweep(read_study(folder / "study.toml"), folder / "undisturbed.sqlite", workers=0).rows)


def _one(folder: Path, source: random.Random, expected: str) -> Record:
    (folder / "study.toml").write_text(STUDY)
    on_cluster = source.random() < CLUSTERS
    faults = [f for f in FAULTS if on_cluster or f != "scheduler"]
    disturbed = Disturbed(folder, source, on_cluster, folder / "s.sqlite")
    for _ in range(source.choice((1, 1, 2))):
        disturbed.disturb(source.choice(faults))
    found = kept(disturbed.store)
    equal = disturbed.finish() == expected
    return {"cluster": on_cluster, "attempts": disturbed.log, "found": found, "equal": equal}


def kept(store: Path) -> int:
    """Finished runs of a store that another process may be writing; 0 where unknown."""
    if not os.path.exists(store):
        return 0
    try:
        with closing(sqlite3.connect(f"file:{os.path.realpath(store)}?mode=ro", uri=True)) as connection:
            return int(connection.execute("select count(*) from runs").fetchone()[0])
    except sqlite3.Error:
        return 0


def is_whole(store: Path) -> bool:
    """Return whether the copy of a store is a store: SQLite may have been writing it."""
    try:
        with closing(sqlite3.connect(store)) as connection:
            return bool(connection.execute("pragma integrity_check(1)").fetchone()[0] == "ok")
    except sqlite3.Error:
        return False


def workers_of(pid: int) -> list[int]:
    """Worker processes of a sweep, from /proc."""
    try:
        children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
        commands = {int(child): Path(f"/proc/{child}/cmdline").read_bytes() for child in children}
    except FileNotFoundError:
        return []
    return [child for child, command in commands.items() if b"spawn_main" in command]


def _kill(pid: int) -> None:
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:  # it was faster
        return


def _limit(size: int) -> Callable[[], None]:
    """In the child: no file may grow beyond the size, as on a full disk, and the write says so."""

    def act() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return act
