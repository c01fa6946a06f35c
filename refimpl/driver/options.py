"""What is asked of a solve: checked input, its defaults, and the plan that follows."""

from __future__ import annotations

from dataclasses import dataclass

from refimpl.accuracy.refinement import Quantity, check_accuracy, check_quantity, deserved_tolerance
from refimpl.errors import InputError, keep_doubles, require_number
from refimpl.grid import Grid
from refimpl.planning.plan import DECISION_GRID, Method, Plan, make_plan
from refimpl.scene.discretise import Posing
from refimpl.scene.scene import Scene
from refimpl.solution.solution import Solution
from refimpl.solvers.paper import PAPER_TOLERANCE

# Of mean pressure and tau over the reduced modulus, and of approaches over the side.
LEAST_STRAIN, MOST_STRAIN = 1e-30, 1e6


@dataclass(frozen=True, kw_only=True)
class Request:
    """The options of `refimpl.solve`, by the same names.

    Raises `InputError` for what is out of range or missing.
    """

    scene: Scene
    grid: int | None = None
    method: Method = "fft"
    accuracy: float | None = None
    quantity: Quantity | None = None
    approach: float | None = None
    oblique: bool | None = None
    slope_correction: bool = False
    coupled: bool | None = None
    tilted: bool | None = None
    tolerance: float | None = None
    start: Solution | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.scene, Scene):
            raise InputError("scene", self.scene, "a Scene (read_scene reads one from a file)")
        self._check_switches()
        if self.approach is not None:
            periodic = self.scene.periodic
            allowed = "an approach below 0 m (mean planes)" if periodic else "a finite approach in m"
            require_number("approach", self.approach, allowed, below=0 if periodic else None)
        self._check_strains()
        check_quantity(self.judged)
        if self.accuracy is not None:
            check_accuracy(self.accuracy)
        require_number("tolerance", self.residual, "a number between 0 and 1", above=0, below=1)
        if (self.grid is None) == (self.accuracy is None):
            allowed = "a number of elements per side, or an accuracy, and not both"
            raise InputError("grid", self.grid, allowed)
        if self.start is not None:
            self._check_start(self.start)
        keep_doubles(self, "accuracy", "approach", "tolerance")

    def _check_strains(self) -> None:
        """Refuse tau, loads and approaches beyond a strain of 1e6: squares of slopes would overflow."""
        side, modulus = self.scene.side, self.scene.materials.reduced_modulus
        most = MOST_STRAIN * modulus
        allowed = f"at most {most:.3g} Pa, {MOST_STRAIN:g} times the reduced modulus"
        require_number("friction.tau", self.scene.friction.tau, allowed, at_most=most)
        if self.approach is None:
            least, most = (strain * modulus * side**2 for strain in (LEAST_STRAIN, MOST_STRAIN))
            share = f"{LEAST_STRAIN:g} to {MOST_STRAIN:g} reduced moduli on the square"
            allowed = f"{least:.3g} to {most:.3g} N, {share}"
            require_number("load", self.scene.load, allowed, at_least=least, at_most=most)
        else:
            most = MOST_STRAIN * side
            allowed = f"at most {most:.3g} m either way, {MOST_STRAIN:g} times the side"
            require_number("approach", self.approach, allowed, at_least=-most, at_most=most)

    def _check_switches(self) -> None:
        for name in ("oblique", "coupled", "tilted"):
            if not isinstance(getattr(self, name), bool | None):
                raise InputError(name, getattr(self, name), "True, False, or None to let the scene decide")
        if not isinstance(self.slope_correction, bool):
            raise InputError("slope_correction", self.slope_correction, "True or False")

    def _check_start(self, start: Solution) -> None:
        if not isinstance(start, Solution):
            raise InputError("start", start, "a Solution")
        if self.method != "fft" or self.grid is None:
            raise InputError("start", start.status.value, "none but for method fft on a grid")
        if start.grid.side != self.scene.side or Grid(self.scene.side, self.grid).M < start.grid.M:
            found = f"{start.grid.M} x {start.grid.M} elements on {start.grid.side} m"
            allowed = f"a solution on at most {self.grid} x {self.grid} elements on {self.scene.side} m"
            raise InputError("start", found, allowed)
        if not start.certified:
            raise InputError("start", start.status.value, "a solution whose certificate holds")

    @property
    def judged(self) -> Quantity:
        """The quantity that the accuracy is about."""
        if self.quantity is not None:
            return self.quantity
        return "contact_area" if self.scene.friction.is_zero else "friction_coefficient"

    @property
    def residual(self) -> float:
        """What every residual of the certificate must meet."""
        if self.tolerance is not None:
            return self.tolerance
        if self.method == "paper":
            return PAPER_TOLERANCE
        return 1e-8 if self.accuracy is None else deserved_tolerance(self.accuracy)

    def plan(self, posing: Posing | None = None) -> Plan:
        """What will be modelled; with an accuracy, the terms for all grids and the grid that decided them.

        ``posing`` samples the heights for it, and keeps them.
        """
        M = 1 if self.grid is None else Grid(self.scene.side, self.grid).M
        return make_plan(
            self.scene,
            M,
            self.method,
            oblique=self.oblique,
            slope_correction=self.slope_correction,
            coupled=self.coupled,
            tilted=self.tilted,
            demand=self.accuracy or self.residual,
            approach=self.approach,
            decide_on=DECISION_GRID if self.grid is None else None,
            of_mu=self.accuracy is not None and self.judged == "friction_coefficient",
            posing=posing,
        )
