"""What the reproduction cases rest on: statistics, tangential kernels, printed numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import dblquad

from verification.cases.appendix_a.fem3d_answer import STEEPEST
from verification.framework import registry
from verification.output.result_files import committed
from verification.reproduction import ensemble, fig6, fig8, slides, table3
from verification.reproduction.printed import MESHES, TABLE2, TABLE3
from verification.reproduction.table1 import hertz
from verification.reproduction.tangential import element_integrals
from verification.sweep.run import Row
from verification.sweep.study_file import study_from_dict


def test_the_printed_table_is_consistent_with_eq_10_on_its_finest_mesh() -> None:
    for column in TABLE3:
        expected = 15e6 * column.contact_area[-1] / 70 + 0.08
        # last digits: 0.0005 of mu, and 0.005e-7 m^2 of A, which is 0.0001 of mu
        assert column.friction_coefficient[-1] == pytest.approx(expected, abs=0.0006)
    assert TABLE3[1].equivalent_rms == pytest.approx(0.511e-6, rel=1e-3)
    assert [grid for grid, *_ in TABLE2[1:]] == list(MESHES)


def test_every_table_and_figure_has_a_case_in_both_tiers() -> None:
    cases = {c.id: c.tier.value for c in registry.load() if c.id.startswith("reproduction/")}
    for name in ("table3-mu", "table3-area", "table3-peak", *(f"fig{n}" for n in range(4, 12))):
        quick = [i for i, tier in cases.items() if i.startswith(f"reproduction/{name}") and tier == "quick"]
        assert quick, name
        for i in quick:
            assert i == "reproduction/fig6d" or cases[f"{i}-full"] == "full"


@pytest.mark.parametrize("values", [[1.0], [1.0, math.nan]])
def test_no_interval_without_values(values: list[float]) -> None:
    with pytest.raises(ValueError, match="two finite"):
        ensemble.estimate(values)


def test_a_column_has_the_rows_of_its_coordinates() -> None:
    study = study_from_dict({"scene": "table1-rough", "vary": {"grid": [12]}, "realisations": 2})
    found = ensemble.rows(study)
    assert len(ensemble.column(found, "contact_area", grid=12)) == 2
    with pytest.raises(LookupError):
        ensemble.column(found, "contact_area", grid=13)


def test_an_ensemble_with_gaps_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    study = study_from_dict({"scene": "table1-rough", "vary": {"grid": [12]}})
    monkeypatch.setattr(ensemble, "CERTIFIED", ())
    with pytest.raises(RuntimeError, match="1 uncertified"):
        ensemble.rows(study)


INTEGRANDS = {
    "1/rho": lambda x, y: 1 / math.hypot(x, y),
    "x^2/rho^3": lambda x, y: x * x / math.hypot(x, y) ** 3,
    "y^2/rho^3": lambda x, y: y * y / math.hypot(x, y) ** 3,
    "xy/rho^3": lambda x, y: x * y / math.hypot(x, y) ** 3,
    "x/rho^2": lambda x, y: x / (x * x + y * y),
    "y/rho^2": lambda x, y: y / (x * x + y * y),
}


@pytest.mark.parametrize("name", INTEGRANDS)
def test_element_integrals_against_quadrature(name: str) -> None:
    kernel, f = element_integrals(4, 0.5)[name], INTEGRANDS[name]
    for i, j in ((1, 0), (-2, 1)):
        x, y = 0.5 * i, 0.5 * j
        exact, error = dblquad(lambda b, a: f(a, b), x - 0.25, x + 0.25, y - 0.25, y + 0.25, epsabs=1e-13)
        assert kernel[3 + i, 3 + j] == pytest.approx(exact, abs=1e-12 + error)


def test_a_trace_knows_how_far_it_is_correlated() -> None:
    # first-order autoregression: correlation a^k, so sum over k = (1 + a)/(1 - a) = 9 steps
    rng, a = np.random.default_rng(3), 0.8
    values = np.zeros(6000)
    for k in range(1, len(values)):
        values[k] = a * values[k - 1] + rng.standard_normal()
    found: list[Row] = [{"sliding_offset": 2.0 * k, "mu": v} for k, v in enumerate(values)]
    trace = slides.trace(found, "mu")
    assert trace.correlated == pytest.approx(9 * 2.0 / 2, rel=0.25)
    assert trace.standard_error == pytest.approx(trace.scatter * math.sqrt(9 / 6000), rel=0.15)


def test_turning_keeps_realisations_and_directions_apart() -> None:
    found: list[Row] = [
        {
            "lower_rms": 1e-6,
            "sliding_direction": phi,
            "friction_force": 10.0 + k + phi,
            "elastic_friction": 1.0,
        }
        for k in range(2)
        for phi in (0.0, 1.0, 2.0)
    ]
    (turned,) = slides.turning(found)
    assert turned.anisotropy.shape == (2, 3)
    assert np.allclose(turned.anisotropy[0], [-1 / 11, 0, 1 / 11])
    assert np.allclose(turned.elastic[1], 1 / np.array([11, 12, 13]))


RMS = np.linspace(0, 1.7e-6, 8)
LAWS = {
    "exponential": np.exp(-RMS / 0.25e-6),
    "algebraic": 1 / (1 + (RMS / 0.25e-6) ** 1.5),
}


def decay_of(mu: np.ndarray) -> fig8.Decay:
    known = np.array([0.0, *np.full(len(mu) - 1, 1e-4)])  # the smooth contact has no error
    return fig8.decay(fig8.Curve(70.0, RMS, mu, 2 * known, known, mu, 2 * known))


@pytest.mark.parametrize("law", LAWS)
def test_decay_knows_its_laws_apart(law: str) -> None:
    found = decay_of(0.09 + 0.1 * LAWS[law])
    misfits = {name: getattr(found, name) for name in LAWS}
    assert misfits.pop(law) < 1e-6
    assert min(misfits.values()) > 0.005
    if law == "exponential":
        assert (found.scale, found.limit) == pytest.approx((0.25e-6, 0.09), rel=1e-5)
        assert found.standard_errors < 0.01


def test_decay_counts_in_standard_errors() -> None:
    mu = 0.09 + 0.1 * LAWS["exponential"]
    mu[4] += 5e-3  # 50 of them, of which the fit takes some up
    assert 25 < decay_of(mu).standard_errors < 50


def test_the_mean_slope_is_the_first_harmonic_and_nothing_else() -> None:
    angle = np.radians(np.arange(0, 360, 30))
    second = np.cos(2 * angle)
    assert slides.beyond_mean_slope(angle, np.array([2 + np.sin(angle), second])) == pytest.approx(0.5)
    assert slides.beyond_mean_slope(angle, np.array([second])) == pytest.approx(1.0)


def test_levels_of_the_effective_pressure() -> None:
    profile = fig6.effective_pressure(0.511e-6, 0, 2, 64)
    assert profile.load_share(profile.hertz) == pytest.approx(1.0, rel=0.02)
    assert profile.load_share(profile.greenwood_tripp) == pytest.approx(1.0, rel=0.02)
    area = np.mean((profile.hertz - profile.greenwood_tripp) ** 2)
    assert profile.without_roughness == pytest.approx(np.sqrt(area) / hertz().peak_pressure, rel=1e-12)


def test_a_cell_compares_ours_with_print() -> None:
    rows: list[Row] = [
        {"lower_rms": c.flat_rms, "grid": 128, "contact_area": 1.1 * c.contact_area[0] * scale}
        for c in TABLE3[1:]
        for scale in (0.9, 1.1)
    ]
    cells = table3.cells(rows, "contact_area", (128,))
    assert [round(cell.deviation, 12) for cell in cells[1:]] == [0.1, 0.1, 0.1]
    assert cells[0].ours.n == 1
    assert [cell.within for cell in cells] == [False, True, True, True]
    assert table3.series(cells)["realisations"] == [1, 2, 2, 2]


def test_numbers_that_one_case_takes_from_another_are_those_of_the_committed_run() -> None:
    """The steepest slope of fem3d/less-than-two-percent takes 75 surfaces of 512 elements to measure."""
    cases = {case["id"]: case for case in committed("reproduction")["cases"]}
    measured = cases["reproduction/largest-slope-full"]["data"]["largest gradient (deg)"]
    assert round(measured, 2) == STEEPEST
