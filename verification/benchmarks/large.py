"""Large grids: work, memory and seconds of whole solves, each in a process of its own.

``python -m verification.benchmarks.large --json FILE`` appends a row a solve to the record; a row that it
holds is not solved again. Work and memory do not depend on what else runs; seconds do.
"""

from __future__ import annotations

import argparse
import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import scipy.fft as sfft

import refimpl as rf
from reports.result_files import read_result
from verification.benchmarks.child import peak_memory
from verification.benchmarks.problems import COPPER, FLATS, FRICTION, LOAD, SIDE, SPHERE, STEEL
from verification.framework.case import jsonable
from verification.framework.files import Progress, to_json, write_result, write_text
from verification.framework.provenance import provenance

HARDNESS = 0.8e9  # Pa
_SELF_AFFINE = rf.SelfAffineRoughness(
    hurst=0.8, rms=0.5e-6, roll_off=0.2e-3, long_cut=0.4e-3, short_cut=10e-6, seed=3
)
_PLANE_LOAD = 400.0  # N: a tenth of the periodic plane in contact
SURFACES: dict[str, tuple[rf.Surface, rf.Surface, bool]] = {
    "smooth": (SPHERE, FLATS["smooth"], False),
    "rough": (SPHERE, FLATS["rough"], False),
    "self-affine": (SPHERE, _SELF_AFFINE, False),
    "periodic self-affine": (rf.Flat(), _SELF_AFFINE, True),
}
TERMS = ("frictionless", "friction and slopes", "friction, slopes and cap")


def scene(surface: str, terms: str) -> rf.Scene:
    """Return the scene of a kind of surface with the terms of that name."""
    upper, lower, periodic = SURFACES[surface]
    soft = rf.Material(E=COPPER.E, nu=COPPER.nu, hardness=HARDNESS if "cap" in terms else None)
    return rf.Scene(
        upper=rf.Body(STEEL, upper),
        lower=rf.Body(soft, lower),
        friction=rf.Friction() if terms == "frictionless" else FRICTION,
        load=_PLANE_LOAD if periodic else LOAD,
        side=SIDE,
        periodic=periodic,
    )


def solved(surface: str, terms: str, M: int) -> dict[str, Any]:
    """Solve in this process and return what it took.

    ``transforms`` is the work of all transforms over that of one real transform of the grid's elements;
    ``bytes an element`` the peak of the process's memory, less that before the solve.
    """
    before = peak_memory()
    began, processor = time.perf_counter(), time.process_time()
    s = rf.solve(scene(surface, terms), grid=M, oblique=None if "slopes" in terms else False)
    seconds, processor = time.perf_counter() - began, time.process_time() - processor
    peak = peak_memory()
    return {
        "status": s.status.name,
        "friction_coefficient": s.friction_coefficient,
        "area share": s.contact_area / s.grid.element_area / M**2,
        "plastic share": s.plastic_area / s.contact_area if s.contact_area else 0.0,
        "worst residual": s.certificate.largest,
        "iterations": sum(s.cost.iterations.values()),
        "finest iterations": s.cost.iterations.get(f"CG at {M} x {M}", 0),
        "transforms": s.cost.point_logs / (M**2 * math.log2(M**2)),
        "bytes an element": (peak - before) / M**2,
        "peak memory (bytes)": peak,
        "seconds": seconds,
        "processor seconds": processor,
        "seconds of one transform": _transform_seconds(M),
    }


def _transform_seconds(M: int) -> float:
    """Seconds of one real transform of the grid's size: the least of two."""
    field = np.random.default_rng(0).random((M, M))
    taken = []
    for _ in range(2):
        began = time.perf_counter()
        sfft.rfft2(field, workers=-1, overwrite_x=True)
        taken.append(time.perf_counter() - began)
    return min(taken)


def main(arguments: Sequence[str] | None = None) -> None:
    """Solve what the record lacks, one process each, and append its rows."""
    parser = argparse.ArgumentParser(prog="python -m verification.benchmarks.large", description=__doc__)
    parser.add_argument("--grids", default="1024,2048,4096", help="elements a side, by commas")
    parser.add_argument("--surfaces", default=",".join(SURFACES), help="by commas")
    parser.add_argument("--terms", default=";".join(TERMS), help="by semicolons")
    parser.add_argument("--threads", default="1", help="numbers of threads, by commas")
    parser.add_argument("--json", type=Path, required=True, help="record to append the rows to")
    parser.add_argument("--one", action="store_true", help="solve one here, and write its row alone")
    options = parser.parse_args(arguments)
    grids = [int(M) for M in options.grids.split(",")]
    surfaces, terms = options.surfaces.split(","), options.terms.split(";")
    if options.one:
        write_text(to_json(jsonable(solved(surfaces[0], terms[0], grids[0]))), options.json)
        return
    wanted = [
        (surface, what, M, int(threads))
        for M in grids
        for surface in surfaces
        for what in terms
        for threads in options.threads.split(",")
    ]
    record = read_result(options.json) if options.json.is_file() else {"rows": []}
    progress = Progress(len(wanted))
    for surface, what, M, threads in wanted:
        row = {"surface": surface, "terms": what, "M": M, "threads": threads}
        if not any(row.items() <= one.items() for one in record["rows"]):
            record["rows"].append(row | _in_a_process(surface, what, M, threads))
            write_result({"provenance": provenance()} | record, options.json)
        progress.tick(f"{surface}, {what}, {M} x {M}")
    progress.close()


def _in_a_process(surface: str, terms: str, M: int, threads: int) -> dict[str, Any]:
    """The row of one solve, or why there is none."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "row.json"
        command = [
            sys.executable,
            "-m",
            "verification.benchmarks.large",
            "--one",
            "--json",
            str(file),
            "--grids",
            str(M),
        ]
        ended = subprocess.run(
            [*command, "--surfaces", surface, "--terms", terms],
            env=os.environ | {"OMP_NUM_THREADS": str(threads)},
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
        if ended.returncode:
            lines = ended.stderr.strip().splitlines()
            return {"failure": lines[-1] if lines else f"exit status {ended.returncode}"}
        found: dict[str, Any] = read_result(file)
        return found


if __name__ == "__main__":
    main()
