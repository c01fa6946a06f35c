"""The reference cases against seeded faults: each fault must fail the cases that name it."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from verification.cases.contact import punch, scenes, smooth, waves
from verification.cases.sliding import reference
from verification.framework import registry
from verification.framework.case import Status

MODULES = (smooth, punch, waves, reference)

Solver = Callable[..., rf.Solution]


def verdict(slug: str) -> Status:
    """Status of the case ``reference/<slug>``, run now."""
    return Status(registry.find(f"reference/{slug}").run().status)


def reversed_coupling(scene: rf.Scene, **options: Any) -> rf.Solution:
    """c with the wrong sign is the shear the other way."""
    return rf.solve(dataclasses.replace(scene, sliding_direction=scene.sliding_direction + np.pi), **options)


def one_per_cent_stiffer(scene: rf.Scene, **options: Any) -> rf.Solution:
    def stiffer(body: rf.Body) -> rf.Body:
        return rf.Body(rf.Material(1.01 * body.material.E, body.material.nu), body.surface)

    return rf.solve(
        dataclasses.replace(scene, upper=stiffer(scene.upper), lower=stiffer(scene.lower)), **options
    )


def without_tau(scene: rf.Scene, **options: Any) -> rf.Solution:
    return rf.solve(
        dataclasses.replace(scene, friction=rf.Friction(tau=0.0, beta=scene.friction.beta)), **options
    )


def transposed(scene: rf.Scene, **options: Any) -> rf.Solution:
    found = rf.solve(scene, **options)
    return dataclasses.replace(found, pressure=found.pressure.T)


def half_an_element_off(scene: rf.Scene, **options: Any) -> rf.Solution:
    found = rf.solve(scene, **options)
    return dataclasses.replace(found, pressure=(found.pressure + np.roll(found.pressure, 1, axis=0)) / 2)


def single_precision(scene: rf.Scene, **options: Any) -> rf.Solution:
    found = rf.solve(scene, **options)
    return dataclasses.replace(found, pressure=found.pressure.astype(np.float32).astype(float))


@pytest.mark.parametrize(
    ("fault", "slugs"),
    [
        (reversed_coupling, ("full-contact-sliding", "sliding-wave-shift", "sheared-sphere-shift")),
        (one_per_cent_stiffer, ("hertz-ellipse-peak", "square-punch-stiffness", "jgh-approach")),
        (without_tau, ("sheared-sphere-shift", "coupled-indentation")),
        (transposed, ("hertz-ellipse-pressure", "full-contact-sliding")),
        (half_an_element_off, ("cone-pressure", "full-contact-rough")),
        (single_precision, ("westergaard-full", "full-contact-rough")),
    ],
)
def test_a_fault_fails_its_cases(
    fault: Solver, slugs: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert all(verdict(slug) is Status.PASS for slug in slugs)

    class Faulty:
        """refimpl with another solve, as the cases see it."""

        def __getattr__(self, name: str) -> Any:
            return fault if name == "solve" else getattr(rf, name)

    monkeypatch.setattr(scenes, "rf", Faulty())
    assert all(verdict(slug) is not Status.PASS for slug in slugs)


def test_a_solver_that_does_not_converge_is_no_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    class Stuck:
        def __getattr__(self, name: str) -> Any:
            return getattr(rf, name)

        def solve(self, scene: rf.Scene, **options: Any) -> rf.Solution:
            return dataclasses.replace(rf.solve(scene, **options), status=rf.Status.STAGNATED)

    monkeypatch.setattr(scenes, "rf", Stuck())
    assert verdict("westergaard-full") is Status.ERROR
