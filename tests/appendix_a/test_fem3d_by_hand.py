"""Extrapolation over meshes and boxes with its uncertainty, and rows of the table, from numbers made up."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from appendix_a.fem3d import coefficients as module
from appendix_a.fem3d.coefficients import Coefficients3D, coefficients
from appendix_a.fem3d.leading_order import waves
from appendix_a.fem3d.patch import normal_coefficient
from appendix_a.fem3d.surface import Sample, X, Y
from appendix_a.fem3d.table import Series, Table3D, condensed
from appendix_a.fem3d.wavy import Kind, Waviness

EXACT = normal_coefficient(X, Y, 0.2)
ODD = 0.01 * np.arange(10.0)


def test_meshes_and_boxes_are_taken_to_their_limits(monkeypatch: pytest.MonkeyPatch) -> None:
    """Errors of 0.1 / level^3 and 0.02 / radius^2 about 0.3 and more, beside a flat surface 1 % too deep."""

    def made(radius: float, level: int) -> Any:
        return 1.31 + ODD + 0.1 / level**3 + 0.02 / (radius / 20.0) ** 2

    def wavy(surface: Waviness, nu: float, radius: float, level: int, edges: object) -> Sample:
        return Sample(EXACT * made(radius, level), 100 * level, 7, 1e-9 * level)

    def flat(wavelength: float, kind: Kind, nu: float, radius: float, level: int) -> Sample:
        return Sample(1.01 * EXACT, 50, 7, 1e-10)

    monkeypatch.setattr(module, "sample", wavy)
    monkeypatch.setattr(module, "flat_sample", flat)
    found = coefficients(10.0, 20.0, 0.25, 0.2)
    assert found.flat == pytest.approx(EXACT)
    assert found.flat_error == pytest.approx(np.full(10, 0.01))
    assert found.error == pytest.approx(0.3 + ODD, abs=1e-9)
    # the last of three meshes lacks 0.1 / 27; limits of both pairs agree; 1.25 is Roache's factor
    assert found.discretisation == pytest.approx(np.full(10, 1.25 * 0.1 / 27), rel=1e-6)
    assert found.truncation == pytest.approx(np.full(10, 1.25 * 0.02 / 9), rel=1e-6)
    assert (found.residual, found.elements) == (pytest.approx(3e-9), 300)
    assert found.antisymmetric == pytest.approx([-0.015] * 3, abs=1e-9)  # +x 1 to 3 are 1, 2, 3 %, -x 4, 5, 6
    assert (found.self_error, found.across[2]) == (pytest.approx(0.3), pytest.approx(0.39))


def test_the_odd_part_is_half_the_difference_of_both_sides() -> None:
    zero = np.zeros(10)
    made = Coefficients3D(zero, np.array([9, 3, 5, 7, 1, 1, 1, 9, 9, 9.0]), zero, zero, zero, 0.0, 1)
    assert made.antisymmetric.tolist() == [1, 2, 3]


def test_plane_waves_add_up_to_the_surface() -> None:
    x, y = np.array([0.0, 1.3, -4.0, 7.0]), np.array([0.4, -2.0, 3.0, 9.0])
    for kind in Kind:
        surface = Waviness(12.0, 18.0, 0.15, kind)
        phase = 2 * np.pi * surface.position
        total = sum(a * np.cos(kx * x + ky * y + phase) for a, kx, ky in waves(surface))
        assert total == pytest.approx(surface.height(x, y), rel=1e-12, abs=1e-15)


def test_of_a_point_the_least_uncertain_row_is_kept() -> None:
    point = {
        "slope_deg": 5.0,
        "wavelength": 20.0,
        "position": 0.25,
        "nu": 0.3,
        "kind": "ridge",
        "width": "projected",
    }
    rows = [
        {**point, "error": [value] * 10, "discretisation": [part] * 10, "truncation": [0.001] * 10}
        for value, part in ((0.1, 0.02), (0.2, 0.01234), (0.3, 0.03))
    ]
    assert condensed(rows) == [{**point, "error": [0.2] * 10, "uncertainty": 0.013}]


def test_what_is_a_crest_to_one_body_is_a_valley_to_the_other() -> None:
    """Errors of 0.1 on a crest, 0.4 in a valley; compliances 0.75 / 3 and 1 / 2: a third and two thirds."""
    table = Table3D(
        {
            Series(20.0, place, nu): {5.0: np.full(10, error), 10.0: np.full(10, 2 * error)}
            for nu in (0.5, 0.0)
            for place, error in ((0.0, 0.1), (0.5, 0.4))
        },
        {},
    )
    crest = Series(20.0, 0.0, 0.3)
    found = table.pair_error(crest, 5.0, lower=(3.0, 0.5), upper=(2.0, 0.0))
    assert found == pytest.approx(np.full(10, (0.1 + 2 * 0.4) / 3))
