"""Problems that the suite poses, each once, with a name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from verification.solver_suite import own
from verification.solver_suite.protocol import Abilities, Answer, ContactProblem
from verification.solver_suite.suite import select

LARGEST = 64
"""Most elements along one axis of an exported problem."""


class PosedProblem(NamedTuple):
    """A problem with its name: the slug of its case, and a number where the case poses several."""

    name: str
    case: str
    problem: ContactProblem


@dataclass
class _Recorder:
    """The production solver as solver under test; keeps the problems that it was given."""

    abilities: Abilities
    problems: list[ContactProblem] = field(default_factory=list)

    def __call__(self, problem: ContactProblem) -> Answer:
        self.problems.append(problem)
        return own.solve(problem)


def problems(globs: Iterable[str] = (), largest: int = LARGEST) -> Iterator[PosedProblem]:
    """Yield the problems of cases of ``globs`` (or all), each once. LookupError where a glob has none."""
    seen: set[tuple[object, ...]] = set()
    for case in select(globs):
        recorder = _Recorder(replace(own.solve.abilities, largest=largest))
        case.case(recorder).run()
        new = {key: problem for problem in recorder.problems if (key := _key(problem)) not in seen}
        seen |= new.keys()
        for number, problem in enumerate(new.values(), start=1):
            yield PosedProblem(f"{case.slug}-{number}" if len(new) > 1 else case.slug, case.id, problem)


def _key(problem: ContactProblem) -> tuple[object, ...]:
    others = (value for name, value in vars(problem).items() if name != "gap")
    return problem.shape, problem.gap.tobytes(), *others
