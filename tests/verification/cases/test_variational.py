"""Cases of Table 2: energy and minimisers against enumeration, timing, and what the cases notice."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Mask
from refimpl.solvers.paper import _Scheme
from verification.cases.paper import iterations, scheme
from verification.cases.solvers import variational
from verification.cases.solvers.variational import (
    PRINTED_HOURS,
    Contact,
    growth,
    timed,
)
from verification.framework.case import Status
from verification.framework.registry import find
from verification.scenes.cross_checks import Trial, pressed

APPROACH = 1.6e-6  # m


@pytest.fixture
def small_table(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(variational, "DENSE_GRIDS", (8, 12))
    monkeypatch.setattr(variational, "FFT_GRIDS", (8, 12, 16))
    variational.table2.cache_clear()
    yield
    variational.table2.cache_clear()


@pytest.mark.nightly
@pytest.mark.usefixtures("small_table")
def test_methods_with_the_matrix_stop_early_and_the_table_is_recorded() -> None:
    found = variational.table2_growth()
    for name, grids in (("paper", [8, 12, 16]), ("L-BFGS-B", [8, 12, 16]), ("NNLS", [8, 12])):
        assert found.data[f"{name}: M"] == grids
        assert len(np.array(found.data[f"{name}: s"])) == len(grids)
    assert found.data["printed variational: exponent on the shared grids"] == pytest.approx(
        np.log(96) / np.log(2.56**2)  # 1 h at 100, 4 days at 256
    )
    assert growth(PRINTED_HOURS["paper"]) == pytest.approx(np.log(103) / np.log(2.56**2))


@pytest.mark.usefixtures("small_table")
def test_a_fast_wrong_answer_has_no_time(monkeypatch: pytest.MonkeyPatch) -> None:
    solve = Contact.solve
    monkeypatch.setattr(
        Contact,
        "solve",
        lambda self, method: (
            (1.01 * solve(self, method)[0], 1.0) if method == "NNLS" else solve(self, method)
        ),
    )
    with pytest.raises(RuntimeError, match="NNLS on 8 x 8: off by 1"):
        variational.table2()


def test_short_calls_are_averaged(monkeypatch: pytest.MonkeyPatch) -> None:
    contact = Contact.on(8)
    calls: list[str] = []

    def solve(self: Contact, method: str) -> tuple[Array, float]:
        calls.append(str(sum(range(100_000))))
        return contact.pressure, 0.0

    monkeypatch.setattr(Contact, "solve", solve)
    _, seconds = timed(contact, "paper")
    assert len(calls) > 1
    assert seconds * len(calls) >= 0.2


def test_load_share_is_the_change_of_the_production_state() -> None:
    one_element = pressed(rms=2e-6, load=1e-4, friction=rf.Friction())  # its pressure is the load
    trial = Trial("", "", one_element, 17, {"oblique": False})
    assert scheme.load_share(trial) == pytest.approx(1e-4, rel=1e-9)
    assert scheme.load_share(scheme.trials()["approach"]) == 0.0


def test_trace_case_sees_an_uncorrected_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """With the residual correction switched off the case fails."""
    iterate = _Scheme._iterate

    def uncorrected(self: _Scheme, u: Array, inside: Mask, *, on_circle: bool) -> Mask:
        return iterate(self, u, inside, on_circle=True)

    monkeypatch.setattr(_Scheme, "_iterate", uncorrected)
    monkeypatch.setattr(iterations, "SCENES", ("hertz",))
    assert find("paper/periodicity-error").run().status == Status.FAIL
