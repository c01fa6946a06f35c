"""Common parts of all adapters: a name, an installed version, abilities, and a way to call the peer."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version
from types import ModuleType

import numpy as np

from verification.framework.case import Unavailable
from verification.solver_suite import identity
from verification.solver_suite.protocol import Abilities, Answer, ContactProblem, Unsupported


@dataclass(frozen=True, eq=False)
class PublishedAnswer(Answer):
    """An answer with the operations that the peer says it took, by its own names."""

    operations: Mapping[str, int] = field(default_factory=dict, kw_only=True)


@dataclass(frozen=True)
class PublishedCode:
    """A published solver under test.

    distribution : its name on the package index
    extra : this project's extra that installs it
    setup : how it is set up, and on whose advice
    press : maps a problem to an answer; may import the peer
    needs : what its installation takes besides the extra, or instead of one
    wrong : known defects of its answers
    """

    distribution: str
    extra: str
    setup: str
    abilities: Abilities
    press: Callable[[ContactProblem], PublishedAnswer]
    needs: str = ""
    wrong: str = ""

    @property
    def installation(self) -> str:
        """Return the command that installs the peer in a checkout of this project.

        >>> never = lambda problem: PublishedAnswer([], True)
        >>> PublishedCode("tamaas", "tamaas", "", Abilities(), never).installation
        "pip install -c constraints.txt -e '.[tamaas]' in a checkout"
        """
        command = f"pip install -c constraints.txt -e '.[{self.extra}]' in a checkout" if self.extra else ""
        return "; ".join(filter(None, [command, self.needs]))

    @property
    def installed(self) -> str | None:
        """The installed version, or None."""
        try:
            return version(self.distribution)
        except PackageNotFoundError:
            return None

    @property
    def version(self) -> str:
        """Name and installed version."""
        return f"{self.distribution} {self.installed or '(not installed)'}"

    @property
    def checksum(self) -> str | None:
        """Checksum of the installed distribution, or None."""
        return identity.of_distribution(self.distribution)

    def __call__(self, problem: ContactProblem) -> PublishedAnswer:
        """Return the peer's answer. Raises `Unavailable` without the peer, `Unsupported` where it cannot."""
        if self.installed is None:
            raise Unavailable(f"{self.distribution} is not installed: {self.installation}")
        lacking = self.abilities.lacking(problem)
        if lacking:
            raise Unsupported(f"{self.distribution} does not offer: {lacking}")
        return self.press(problem)


def closure(problem: ContactProblem) -> float:
    """Return the mean gap under the pressure (m) that meets the tolerance, ``sum f (v - min v) / sum f``.

    The relative gap is that over half the mean displacement under the pressure, ``depth``: at least that of
    the square punch that contains the contact, 0.87 P / (E* max(Lx, Ly)); at an approach d at least d / 2.
    Periodic, it is half the heights' deviation when light, a third near full contact, and less beyond: twice
    the energy that flattens the surface, over the load.
    """
    if problem.load is not None:
        depth = 0.87 * problem.load / (problem.reduced_modulus * max(problem.lengths))
    else:
        assert problem.approach_from_touch is not None
        depth = 0.5 * abs(problem.approach_from_touch)
    if problem.periodic and problem.gap.any():
        depth = min(depth, float(problem.gap.std()) / 3)
        if problem.load is not None:
            depth = min(depth, 2 * _flattening(problem) / problem.load)
    return 0.5 * problem.tolerance * depth


def _flattening(problem: ContactProblem) -> float:
    """Return the elastic energy (J) of periodic full contact: pressures ``E* q/2`` times its waves."""
    x, y = (2 * np.pi * np.fft.fftfreq(n, d) for n, d in zip(problem.shape, problem.spacings, strict=True))
    wave = np.hypot(x[:, None], y)
    pressure = np.fft.ifft2(np.fft.fft2(problem.gap) * wave * (0.5 * problem.reduced_modulus)).real
    return 0.5 * float(np.vdot(pressure, problem.gap)) * problem.element_area


def imported(name: str) -> ModuleType:
    """Return a peer's module, as an untyped one: none of the peers ships type hints."""
    return importlib.import_module(name)
