"""Materials: nu from -1 to 1/2, ratios of moduli from 1e-6 to 1e6."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import refimpl as rf
from refimpl.planning.plan import Method
from verification.extremes.judge import SOLVERS, by_oracle, guarded
from verification.extremes.state import Extreme, Judged, axis
from verification.scenes.cross_checks import STEEL, TABLE1, pressed

M = 5
RATIOS = (
    -1.0, -1 + 2**-53, -1 + 1e-12, -1 + 1e-6, -1 + 1e-3, -0.9, -0.5, -1e-300, 0.0, 1e-300, 0.25,
    0.49, 0.4999, 0.5 - 1e-9, 0.5 - 2**-54, 0.5, 0.5 + 2**-53,
)  # fmt: skip


def pair(upper: rf.Material, lower: rf.Material, beta: float = 0.3) -> rf.Scene:
    """The ball on a rough flat, strongly rubbed, at a mean pressure of 1e-4 of the pair's modulus."""
    scene = pressed(upper=upper, lower=lower, rms=0.5e-6, direction=0.7)
    load = 1e-4 * scene.materials.reduced_modulus * scene.lengths[0] ** 2
    tau = 1e-2 * load / scene.lengths[0] ** 2
    return replace(scene, load=load, friction=replace(TABLE1, tau=tau, beta=beta))


def of_ratios(upper: float, lower: float, method: Method) -> Judged:
    """Bodies of two Poisson's ratios, which may be refused."""
    return guarded(lambda: by_oracle(pair(rf.Material(2e11, upper), rf.Material(3e9, lower)), M, method))


@axis("material")
def materials() -> Iterator[Extreme]:
    """Poisson's ratio of one body, of both; the modulus of the lower body over the upper one's."""
    for method in SOLVERS:
        for nu in RATIOS:
            yield Extreme(
                "material", f"nu of the lower body, {method}", f"{nu!r}", nu,
                partial(of_ratios, STEEL.nu, nu, method),
            )  # fmt: skip
        for nu in RATIOS[1:-1]:
            yield Extreme(
                "material", f"nu of both, {method}", f"{nu!r}", nu,
                partial(of_ratios, nu, nu, method),
            )  # fmt: skip
        for exponent in range(-6, 7):
            yield Extreme(
                "material", f"modulus ratio, {method}", f"1e{exponent}", 10.0**exponent,
                partial(by_oracle, pair(STEEL, rf.Material(STEEL.E * 10.0**exponent, 0.1)), M, method),
            )  # fmt: skip
