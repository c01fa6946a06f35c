"""One way to solve a scene, run: its numbers, its status, and what it took."""

from __future__ import annotations

import math
import time
import tracemalloc
from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import dataclass
from unittest import mock

import numpy as np
import scipy.fft as sfft

import refimpl as rf
from refimpl.grid import Array, Shape, Window
from refimpl.grid.window import padded_length
from refimpl.model.friction import friction_coefficient_at
from refimpl.model.problem import Problem
from refimpl.solvers.production import nested_solver
from verification.tradeoff.settings import Setting
from verification.tradeoff.single import single_precision
from verification.variational.energy import Energy, frictionless
from verification.variational.minimisers import quasi_newton

QUANTITIES = ("friction_coefficient", "contact_area", "max_pressure")


@dataclass(frozen=True)
class Run:
    """A way's numbers by quantity, its status, processor seconds, and applications counted by n log n."""

    setting: Setting
    numbers: Mapping[str, float]
    status: str
    seconds: float
    convolutions: float
    limit: float
    """Processor seconds of one convolution on the contact's padded bounding box."""
    peak_bytes: int


def run(scene: rf.Scene, setting: Setting, repeats: int) -> Run:
    """Solve ``repeats`` times for the least processor time, and once more for the peak of memory."""
    seconds = math.inf
    for _ in range(repeats):
        started = time.process_time()
        numbers, status, pressure, work = _solved(scene, setting)
        seconds = min(seconds, time.process_time() - started)
    tracemalloc.start()
    _solved(scene, setting)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    shape = _padded_box(pressure)
    points = math.prod(shape)
    return Run(
        setting, numbers, status, seconds, work / (points * math.log2(points)), _convolution_time(shape), peak
    )


def _solved(scene: rf.Scene, setting: Setting) -> tuple[dict[str, float], str, Array, float]:
    """Numbers, status, pressure, and the sum of n log n over all applications."""
    if setting.method == "qp":
        return _minimised(scene, setting)
    one_grid = mock.patch.object(nested_solver, "nested_problems", _only_the_finest)
    precision = single_precision() if setting.single else nullcontext()
    with nullcontext() if setting.nested else one_grid, precision:
        solution = _solution(scene, setting)
    numbers = {name: float(getattr(solution, name)) for name in QUANTITIES}
    return numbers, solution.status.value, solution.pressure, solution.cost.point_logs


def _only_the_finest(problem: Problem, above: Shape | None) -> list[Problem]:
    return [problem]


def _solution(scene: rf.Scene, setting: Setting) -> rf.Solution:
    assert setting.method != "qp"
    return rf.solve(
        scene,
        setting.M,
        method=setting.method,
        tolerance=None if setting.method == "paper" else setting.tolerance,
        oblique=setting.oblique,
        coupled=setting.coupled,
    )


def _minimised(scene: rf.Scene, setting: Setting) -> tuple[dict[str, float], str, Array, float]:
    """The minimum of the frictionless energy, with Eq. (10) for the friction."""
    approach = rf.solve(scene, setting.M, oblique=False, coupled=False).approach
    energy = Energy(frictionless(scene, setting.M, approach))
    pressure = energy.pressure(quasi_newton(energy).x)
    area = float(np.count_nonzero(pressure > 0)) * energy.problem.grid.element_area
    numbers = {
        "friction_coefficient": friction_coefficient_at(scene.friction, scene.load / area),
        "contact_area": area,
        "max_pressure": float(pressure.max()),
    }
    return numbers, "converged", pressure, energy.counter.point_logs


def _padded_box(pressure: Array) -> tuple[int, int]:
    n, m = Window.around(pressure > 0, margin=0).shape
    return padded_length(2 * n - 1), padded_length(2 * m - 1)


def _convolution_time(shape: tuple[int, int]) -> float:
    """Processor seconds of one real transform there and back, the least of five.

    By the thread's clock: that of the process advances in milliseconds where processor time is limited.
    """
    values = np.zeros(shape)
    least = math.inf
    for _ in range(5):
        started = time.thread_time()
        sfft.irfft2(sfft.rfft2(values), s=shape)
        least = min(least, time.thread_time() - started)
    return least
