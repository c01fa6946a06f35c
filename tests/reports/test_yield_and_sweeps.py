"""The figure of section 8 beyond yield and the tables of sweeps, number by number."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure as Canvas

from reports.studies import sweeps
from reports.yield_figures import BEYOND_YIELD

LOADS, MODELS = ("14 N", "42 N", "70 N"), ("elastic", "capped")


def half_widths(axes: Any) -> list[float]:
    """Half of each error bar's length at the first place."""
    segments = [container.lines[2][0].get_segments()[0] for container in axes.containers]
    return [float(np.ptp(segment[:, 1])) / 2 for segment in segments]


def test_each_mean_of_section_8_has_its_own_interval() -> None:
    """Curves in the order of loads, elastic before capped: half widths of 0.001 to 0.006."""
    data: dict[str, Any] = {"sigma_e (um)": [0.5, 1.0], "psi": [1.0, 2.0], "Eq. (11)": 0.1}
    for k, (load, model) in enumerate((load, model) for load in LOADS for model in MODELS):
        width = 0.001 * (k + 1)
        data |= {
            f"mu, {model}, {load}": [0.11 + 0.001 * k] * 2,
            f"mu half width, {model}, {load}": [width] * 2,
        }
        data |= {f"A (mm^2), {model}, {load}": [k + 1.0] * 2}
        data |= {f"A half width (mm^2), {model}, {load}": [10 * width] * 2}
        data |= {f"mean pressure / H, {model}, {load}": [0.1 * k, 0.2], f"plastic share, {load}": [0.3, 0.4]}
    canvas = Canvas()
    BEYOND_YIELD[0].draw(canvas, data)
    friction, area, pressure, share = canvas.axes
    assert half_widths(friction) == pytest.approx([0.001, 0.002, 0.003, 0.004, 0.005, 0.006])
    assert half_widths(area) == pytest.approx([0.01, 0.02, 0.03, 0.04, 0.05, 0.06])
    means = [container.lines[0].get_ydata()[0] for container in friction.containers]
    assert means == pytest.approx([0.11, 0.111, 0.112, 0.113, 0.114, 0.115])
    assert [line.get_ydata()[0] for line in pressure.lines[:6]] == pytest.approx([0, 0.1, 0.2, 0.3, 0.4, 0.5])
    assert [list(line.get_ydata()) for line in share.lines] == [[0.3, 0.4]] * 3


def test_work_from_a_neighbour_stands_beside_that_of_a_cold_solve() -> None:
    row = {"surface": "rough", "neighbour": "load", "cold": 41.2, "from the neighbour": 12.6}
    found = sweeps.build({"grid": 256, "neighbours": [row], "seconds a run": {"2": 0.12345}})
    workers, neighbours = found.tables
    assert list(zip(neighbours.head, neighbours.rows[0], strict=True)) == [
        ("surface", "rough"), ("neighbour", "load"), ("cold", "41"), ("from the neighbour", "13"),
    ]  # fmt: skip
    assert (workers.rows, "256²" in workers.caption) == ([("2", "0.123")], True)
