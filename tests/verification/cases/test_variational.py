"""Cases of Table 2: energy and minimisers against enumeration, timing, and what the cases notice."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

import refimpl as rf
from refimpl.grid import Array, Mask
from refimpl.solvers.paper import _Scheme
from verification.cases.paper import iterations, scheme
from verification.cases.solvers import variational
from verification.cases.solvers.variational import (
    Contact,
)
from verification.framework.case import Status
from verification.framework.registry import find
from verification.scenes.cross_checks import Trial, pressed


@pytest.fixture
def small_table(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(variational, "DENSE_GRIDS", (8, 12))
    monkeypatch.setattr(variational, "FFT_GRIDS", (8, 12, 16))
    variational.table2.cache_clear()
    yield
    variational.table2.cache_clear()


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
