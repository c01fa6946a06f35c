"""The plan of a solve: which terms enter, which are neglected with what effect, and the memory it takes."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Literal

from refimpl.errors import InputError
from refimpl.grid import Grid
from refimpl.model.problem import Problem, Terms
from refimpl.operating_system import free_memory
from refimpl.planning.expected_contact import ExpectedContact, expected_contact
from refimpl.planning.terms import Term, budget_of, choose

Method = Literal["dense", "fft", "paper"]
METHODS: tuple[Method, ...] = ("dense", "fft", "paper")

DECISION_GRID = 256  # elements along the longer side on which terms are decided for all grids of a refinement

# Bytes per element at the peak, measured with slopes and coupling: of the grid, when the solution is built
# from the certified state; of the contact's window before that: FFT work arrays, two kernel tables and their
# transforms; or dense matrices of Eq. (7), 9.1 of them (24 to 48 elements a side).
_GRID_BYTES, _WINDOW_BYTES = 176, 520
_GROWTH = 1.5  # a window over the contact expected from heights: 0.7 to 2.3 of it on rough balls, as solved
_DENSE_MATRICES = 10
UNREAD = 2**26  # bytes up to which the free memory is not read: that takes 1 ms, a tenth of a small solve
LARGEST_DENSE = 64 * 64  # elements; `refimpl.plain` takes no more

_RESTORED = "restored: the solved contact shows that it matters"


@dataclass(frozen=True)
class Plan:
    """Terms modelled on a grid, terms neglected, and the reasons.

    method : the solver
    grid : shape and lengths
    terms : all terms in a fixed order
    memory : estimate (bytes)
    demand : relative accuracy that effects are compared with
    budget : what the effects of all neglected terms may add up to
    requested : what the user requested
    decided_on : number of elements of the grid whose heights decided
    contact : the contact to expect there
    """

    method: Method
    grid: Grid
    terms: tuple[Term, ...]
    memory: int
    demand: float
    budget: float
    requested: Terms
    decided_on: int
    contact: ExpectedContact

    def term(self, name: str) -> Term:
        """Return a term by the name of its switch, or "active_set"."""
        return next(term for term in self.terms if term.name == name)

    def includes(self, name: str) -> bool:
        """Return whether a term is modelled."""
        return self.term(name).included

    @property
    def neglected(self) -> tuple[str, ...]:
        """Names of the terms that have an effect and are neglected because it is small."""
        return tuple(term.name for term in self.terms if term.negligible)

    @property
    def switches(self) -> Terms:
        """The terms as the solvers' switches."""
        return Terms(**{f.name: self.includes(f.name) for f in fields(Terms)})

    def on(self, grid: Grid) -> Plan:
        """Return the same terms on another grid, checked against the free memory."""
        memory = memory_of(self.method, grid, extent=self.contact.extent)
        return replace(self, grid=grid, memory=memory)

    def restore(self, problem: Problem, name: str) -> Plan:
        """Return the plan with a neglected term that the solved contact shows to matter; slopes stay."""
        requested = replace(self.requested, **{name: True})
        chosen = choose(problem, self.contact, requested, self.budget, for_mu=self.includes("oblique"))
        restored = {name} | {term.name for term in self.terms if term.reason == _RESTORED}
        terms = tuple(replace(t, reason=_RESTORED) if t.name in restored else t for t in chosen)
        return replace(self, terms=terms, requested=requested)


def make_plan(
    problem: Problem,
    method: Method = "fft",
    requested: Terms | None = None,
    *,
    demand: float = 1e-8,
    for_mu: bool = False,
) -> Plan:
    """Decide the terms from the heights of a problem, for its grid or for all grids of a refinement.

    ``demand`` is the relative accuracy required of mu and A (``for_mu``: of mu above all) that each term's
    effect is compared with. Memory is estimated and not checked: on a grid that is only decided on nothing
    is solved (`memory_of`, `Plan.on`).
    """
    requested = requested or Terms()
    requested.check()
    contact = expected_contact(problem)
    budget = budget_of(problem, contact, demand)
    return Plan(
        method=method,
        grid=problem.grid,
        terms=choose(problem, contact, requested, budget, for_mu=for_mu),
        memory=estimated_memory(method, problem.grid, extent=contact.extent),
        demand=demand,
        budget=budget,
        requested=requested,
        decided_on=problem.grid.elements,
        contact=contact,
    )


def estimated_memory(method: Method, grid: Grid, *, extent: float = 0.0) -> int:
    """Return the bytes at a solve's peak; ``extent``: the expected contact's rectangle over the grid."""
    if method == "dense":
        return 8 * _DENSE_MATRICES * grid.elements**2
    return round(max(_GRID_BYTES, _WINDOW_BYTES * min(1.0, _GROWTH * extent)) * grid.elements)


def memory_of(method: Method, grid: Grid, *, extent: float = 0.0) -> int:
    """Return the `estimated_memory`; `InputError` if it exceeds the free memory or the dense method."""
    if method == "dense" and grid.elements > LARGEST_DENSE:
        raise InputError("grid", max(grid.shape), f"at most {LARGEST_DENSE} elements by method dense")
    memory = estimated_memory(method, grid, extent=extent)
    if memory > UNREAD and memory > (free := free_memory()):
        allowed = f"a grid whose estimated {memory / 1e9:.3g} GB fit into the free {free / 1e9:.3g} GB"
        raise InputError("grid", max(grid.shape), allowed)
    return memory
