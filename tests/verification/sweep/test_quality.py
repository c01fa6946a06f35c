"""Error bars against scatter, and counted warnings, by hand."""

from __future__ import annotations

import math

from verification.sweep.quality import quality_of, warnings_of
from verification.sweep.run import COORDINATES, Row


def row(realisation: int, mu: float, area: float, status: str = "converged", warnings: str = "") -> Row:
    return dict.fromkeys(COORDINATES) | {
        "realisation": realisation,
        "status": status,
        "friction_coefficient": mu,
        "friction_coefficient_error": 0.01,
        "contact_area": area,
        "contact_area_error": math.inf,
        "warnings": warnings,
    }


def test_error_and_scatter_by_hand() -> None:
    # mu 0.1 and 0.3: mean 0.2, sd sqrt(0.02) = 0.1414, relative 0.7071; errors 0.1 and 0.0333, median 0.0667
    mu, area = quality_of([row(0, 0.1, 1.0), row(1, 0.3, 1.0), row(2, 9.0, 9.0, "stagnated")])
    assert mu.scatter is not None
    assert abs(mu.scatter - math.sqrt(0.5)) < 1e-12
    assert abs(mu.error - (0.1 + 1 / 30) / 2) < 1e-12
    assert not mu.is_biased
    assert (area.error, area.scatter, area.is_biased) == (math.inf, 0.0, True)


def test_one_realisation_has_no_scatter() -> None:
    assert [found.scatter for found in quality_of([row(0, 0.1, 1.0)])] == [None, None]


def test_warnings_are_counted_by_name() -> None:
    rows = [row(0, 0.1, 1.0, warnings="border; contact radius"), row(1, 0.1, 1.0, warnings="border")]
    assert warnings_of(rows) == {"border": 2, "contact radius": 1}


def test_a_number_is_biased_from_half_of_its_points_on() -> None:
    """Errors of 10 % at all points; scatter of none at one, of 71 % at the others."""

    def points(wide: int) -> list[Row]:
        values = [(0, 0.1, 0.1), *((k + 1, 0.1, 0.3) for k in range(wide))]
        return [row(k, mu, 1.0) | {"load": load} for load, *both in values for k, mu in enumerate(both)]

    assert [quality_of(points(wide))[0].is_biased for wide in (1, 2)] == [True, False]


def test_a_bar_without_an_end_is_infinite() -> None:
    rows = [row(0, 0.1, 1.0) | {"contact_area_error": None}]
    assert quality_of(rows)[1].error == math.inf
