"""Computes the map of `coefficient_map`: a FEM solve per slope, wavelength and position, in processes."""

from __future__ import annotations

import math
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from itertools import product

import numpy as np
from numpy.typing import NDArray

from appendix_a.fem.coefficient_map import CoefficientMap, check_ascending, height_change
from appendix_a.fem.sinusoid import departures

Array = NDArray[np.float64]
SLOPES_DEG = (2.5, 10.0, 17.5, 25.0, 30.0)
WAVELENGTHS = (8.0, 9.0, 11.0, 14.0, 18.0, 25.0, 40.0, 72.0, 256.0)  # dense where 1 / wavelength is large
POSITIONS = tuple(k / 12 for k in range(7))
OFFSETS = (-10.0, -8.0, -6.0, -4.0, -2.0, 2.0, 4.0, 6.0, 8.0, 10.0)  # centres of other elements
STEEP = 20.0  # degrees; beyond, meshes are one level finer
JUDGED_NU = (0.0, 0.3, 0.5)  # the error is linear in kappa too, so its ends bound it


def compute(
    slopes_deg: tuple[float, ...] = SLOPES_DEG,
    wavelengths: tuple[float, ...] = WAVELENGTHS,
    positions: tuple[float, ...] = POSITIONS,
    *,
    workers: int = 2,
    progress: Callable[[int, int], None] | None = None,
) -> CoefficientMap:
    """Solve every geometry in `workers` processes; `progress(done, all)` after each slope and wavelength.

    slopes_deg: degrees; wavelengths: in half-widths; positions: in wavelengths.  Raises InputError for an
    axis that does not ascend strictly: splines over it need that.
    """
    check_ascending(slopes_deg=slopes_deg, wavelengths=wavelengths, positions=positions)
    jobs = [(slope, wavelength, positions) for wavelength, slope in product(wavelengths, slopes_deg)]
    shape = (len(slopes_deg), len(wavelengths), len(positions), len(OFFSETS))
    arrays = np.zeros(shape), np.zeros(shape), np.zeros(shape[:3])
    table = CoefficientMap(slopes_deg, wavelengths, positions, OFFSETS, *arrays)
    with _processes(workers) as pool:
        solving = [pool.submit(_batch, job) for job in jobs]
        for done, (job, batch) in enumerate(zip(jobs, solving, strict=True), start=1):
            i, j = slopes_deg.index(job[0]), wavelengths.index(job[1])
            parts = batch.result()
            table.kappa_part[i, j], table.constant_part[i, j], table.error_percentage_points[i, j] = parts
            if progress is not None:
                progress(done, len(jobs))
    return table


@contextmanager
def _processes(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Start worker processes that end with the block, after an error or an interrupt at once.

    They ignore an interrupt themselves, which a terminal sends to all: it is this process that ends them.
    """
    ignored = (signal.SIGINT, signal.SIG_IGN)
    pool = ProcessPoolExecutor(workers, initializer=signal.signal, initargs=ignored)
    try:
        yield pool
    except BaseException:
        # public from Python 3.14: `terminate_workers`; what waits then is broken, and must not be cancelled
        for process in list(pool._processes.values()):
            process.terminate()
        raise
    finally:
        pool.shutdown()


def _batch(job: tuple[float, float, tuple[float, ...]]) -> tuple[Array, Array, Array]:
    slope, wavelength, positions = job
    found = [_geometry(slope, wavelength, position) for position in positions]
    parts_a, parts_b, errors = zip(*found, strict=True)
    return np.array(parts_a), np.array(parts_b), np.array(errors)


def _geometry(slope: float, wavelength: float, position: float) -> tuple[Array, Array, float]:
    """Return A and B (m,) beyond the first order over tan(slope)^2, and the error in percentage points."""
    offsets = np.array(OFFSETS)
    levels = (0, 1, 2) if slope < STEEP else (1, 2, 3)
    solved = departures(slope, wavelength, position, offsets, levels)
    at_zero, at_half = solved.meshes[-1].at(0.0), solved.meshes[-1].at(0.5) / 1.5
    kappa_part = (at_zero - at_half) / 2.0  # kappa = 3 and 1
    constant_part = at_half - kappa_part
    first = height_change(slope, wavelength, position, offsets) / 2.0  # (1 - 2 nu) = (kappa - 1) / 2
    square = math.tan(math.radians(slope)) ** 2
    worst = max(float(np.max(solved.result(nu).percentage_points)) for nu in JUDGED_NU)
    return (kappa_part + first) / square, (constant_part - first) / square, worst
