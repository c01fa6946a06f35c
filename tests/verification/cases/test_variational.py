"""Cases of Table 2: timing, and what the cases notice."""

from __future__ import annotations

import pytest

import refimpl as rf
from refimpl.grid import Array, Mask
from refimpl.solvers.paper import _Scheme
from verification.cases.paper import iterations, scheme
from verification.cases.solvers.variational import Contact, seconds_of
from verification.framework.case import Status
from verification.framework.registry import find
from verification.scenes.cross_checks import Trial, pressed

APPROACH = 1.6e-6  # m


def test_short_calls_are_averaged_and_a_wrong_answer_has_no_time(monkeypatch: pytest.MonkeyPatch) -> None:
    contact = Contact.on(8)
    calls: list[str] = []

    def solve(self: Contact, method: str) -> tuple[Array, float]:
        calls.append(str(sum(range(100_000))))
        return (1.01 if method == "NNLS" else 1.0) * contact.pressure, 0.0

    monkeypatch.setattr(Contact, "solve", solve)
    seconds = seconds_of(contact, "paper")
    assert len(calls) > 1
    assert seconds * len(calls) >= 0.2
    with pytest.raises(RuntimeError, match="NNLS: off by 1"):
        seconds_of(contact, "NNLS")


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
