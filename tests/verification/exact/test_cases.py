"""The reference cases against seeded faults: each fault must fail the cases that name it."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array
from tests.changed import changed
from verification.cases.contact import scenes
from verification.framework import registry
from verification.framework.case import Status

Solver = Callable[..., rf.Solution]


def verdict(slug: str) -> Status:
    """Status of the case ``reference/<slug>``, run now."""
    registry.load()
    return Status(registry.find(f"reference/{slug}").run().status)


def one_per_cent_stiffer(body: rf.Body) -> rf.Body:
    return rf.Body(rf.Material(1.01 * body.material.E, body.material.nu), body.surface)


def scene_fault(change: Callable[[rf.Scene], dict[str, Any]]) -> Solver:
    def solve(scene: rf.Scene, **options: Any) -> rf.Solution:
        return rf.solve(dataclasses.replace(scene, **change(scene)), **options)

    return solve


def pressure_fault(change: Callable[[Array], Array]) -> Solver:
    def solve(scene: rf.Scene, **options: Any) -> rf.Solution:
        found = rf.solve(scene, **options)
        return changed(found, pressure=change(found.pressure))

    return solve


FAULTS = {
    # c with the wrong sign is the shear the other way
    "coupling reversed": scene_fault(lambda scene: {"sliding_direction": scene.sliding_direction + np.pi}),
    "one per cent stiffer": scene_fault(
        lambda scene: {name: one_per_cent_stiffer(getattr(scene, name)) for name in ("upper", "lower")}
    ),
    "without tau": scene_fault(lambda scene: {"friction": rf.Friction(tau=0.0, beta=scene.friction.beta)}),
    "transposed": pressure_fault(lambda p: p.T),
    "half an element off": pressure_fault(lambda p: (p + np.roll(p, 1, axis=0)) / 2),
    "single precision": pressure_fault(lambda p: p.astype(np.float32).astype(float)),
}


@pytest.mark.parametrize(
    ("fault", "slugs"),
    [
        ("coupling reversed", ("full-contact-sliding", "sliding-wave-shift")),
        ("one per cent stiffer", ("jgh-approach", "hertz-ellipse-outside")),
        ("without tau", ("sheared-sphere-shift", "coupled-indentation")),
        ("transposed", ("full-contact-sliding",)),
        ("half an element off", ("full-contact-rough",)),
        ("single precision", ("westergaard-full", "full-contact-rough")),
    ],
)
def test_a_fault_fails_its_cases(fault: str, slugs: tuple[str, ...], monkeypatch: pytest.MonkeyPatch) -> None:
    assert all(verdict(slug) is Status.PASS for slug in slugs)

    class Faulty:
        """refimpl with another solve, as the cases see it."""

        def __getattr__(self, name: str) -> Any:
            return FAULTS[fault] if name == "solve" else getattr(rf, name)

    monkeypatch.setattr(scenes, "rf", Faulty())
    assert all(verdict(slug) is not Status.PASS for slug in slugs)


def test_a_solver_that_does_not_converge_is_no_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    class Stuck:
        def __getattr__(self, name: str) -> Any:
            return getattr(rf, name)

        def solve(self, scene: rf.Scene, **options: Any) -> rf.Solution:
            return changed(rf.solve(scene, **options), status=rf.Status.STAGNATED)

    monkeypatch.setattr(scenes, "rf", Stuck())
    assert verdict("westergaard-full") is Status.ERROR
