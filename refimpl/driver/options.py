"""The options of `refimpl.solve`: checks and defaults."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

from refimpl.accuracy.refinement import check_accuracy, tolerance_for
from refimpl.driver.limits import Limits
from refimpl.errors import InputError, keep_doubles, require_number, require_one_of, size_text
from refimpl.grid import Grid
from refimpl.model.friction import is_frictionless
from refimpl.model.problem import Terms
from refimpl.planning.plan import DECISION_GRID, LARGEST_DENSE, METHODS, Method, Plan, make_plan, memory_of
from refimpl.scene.discretise import Discretiser
from refimpl.scene.scene import Scene
from refimpl.solution.quantities import check_has_bar, check_target
from refimpl.solution.solution import Solution
from refimpl.solvers.paper import PAPER_TOLERANCE

# Limits of mean pressure and tau over the reduced modulus, and of approaches over the side.
LEAST_STRAIN, MOST_STRAIN = 1e-30, 1e6
_SMALL_DOMAIN = 5e-6  # m: below the scans of a probe microscope, and a map in mm read as um


@dataclass(frozen=True, kw_only=True)
class Options:
    """The options of `refimpl.solve`, by the same names.

    Raises `InputError` for a value that is out of range or missing.
    """

    scene: Scene
    grid: int | tuple[int, int] | None = None
    method: Method = "fft"
    accuracy: float | None = None
    quantity: str | None = None
    approach: float | None = None
    requested: Terms = field(default_factory=Terms)
    tolerance: float | None = None
    start: Solution | None = None
    limits: Limits = field(default_factory=Limits)

    def __post_init__(self) -> None:
        self.requested.check()
        if not isinstance(self.scene, Scene):
            raise InputError("scene", self.scene, "a Scene (read_scene reads one from a file)")
        if self.approach is not None:
            self.scene.check_approach(self.approach)
        self._check_strains()
        self._check_method()
        self._check_plastic()
        check_target(self.target_quantity)
        if self.accuracy is not None:
            check_accuracy(self.accuracy)
            check_has_bar(self.target_quantity, self.scene.friction)
        require_number("tolerance", self.residual_tolerance, "a number between 0 and 1", above=0, below=1)
        if self.grid is None and self.accuracy is None:
            most = math.isqrt(LARGEST_DENSE) if self.method == "dense" else self.scene.default_grid
            object.__setattr__(self, "grid", min(self.scene.default_grid, most))
        if self.grid is not None and self.accuracy is not None:
            raise InputError("grid", self.grid, "none beside an accuracy, which chooses the grid")
        for name, value in self.limits.given.items() if self.accuracy is None else ():
            raise InputError(name, value, "none without an accuracy")
        _ = self.solve_grid  # refuses what is no grid
        if self.start is not None:
            self._check_start(self.start)
        keep_doubles(self, "accuracy", "approach", "tolerance")

    def _check_method(self) -> None:
        require_one_of("method", self.method, METHODS)
        if self.method == "paper" and self.scene.periodic:
            raise InputError("method", self.method, "dense or fft for a periodic scene")

    def _check_plastic(self) -> None:
        """Take the scene's choice where there is no other, elastic where no cap can be; refuse the rest."""
        scene, plastic = self.scene, self.requested.plastic
        plastic = scene.plastic if plastic is None else plastic
        hardness = scene.materials.softer_hardness
        if plastic and hardness is None:
            raise InputError("plastic", plastic, "a hardness of one body at least (Pa)")
        if plastic and self.method == "paper":
            raise InputError("method", self.method, "dense or fft: the paper's scheme has no pressure cap")
        if plastic is None and (self.method == "paper" or self.requested.slope_correction):
            plastic = False
        object.__setattr__(self, "requested", replace(self.requested, plastic=plastic))
        if plastic is False or hardness is None or self.approach is not None:
            return
        most = hardness * scene.lengths[0] * scene.lengths[1]
        allowed = (
            f"at most {most:.6g} N, the softer body's hardness, {hardness:.4g} Pa, times the nominal area "
            f"({'load in mN? ' if 1e-3 * scene.load <= most else ''}"
            "1 HV is 10.6e6 Pa, 1 GPa 1e9 Pa; or plastic = false)"
        )
        if max(scene.lengths) < _SMALL_DOMAIN:
            size = f"the domain is only {size_text(scene.lengths)} m (units of the map, or its pixel?)"
            allowed = f"{size}; {allowed}"
        require_number("load", scene.load, allowed, at_most=most)

    def _check_strains(self) -> None:
        """Refuse tau, loads and approaches beyond a strain of 1e6: squares of slopes would overflow."""
        size, modulus = max(self.scene.lengths), self.scene.materials.reduced_modulus
        most = MOST_STRAIN * modulus
        allowed = f"at most {most:.3g} Pa, {MOST_STRAIN:g} times the reduced modulus"
        require_number("friction.tau", self.scene.friction.jump, allowed, at_most=most)
        if self.approach is None:
            area = self.scene.lengths[0] * self.scene.lengths[1]
            least, most = (strain * modulus * area for strain in (LEAST_STRAIN, MOST_STRAIN))
            share = f"{LEAST_STRAIN:g} to {MOST_STRAIN:g} reduced moduli on the domain"
            allowed = f"{least:.3g} to {most:.3g} N, {share}"
            require_number("load", self.scene.load, allowed, at_least=least, at_most=most)
        else:
            most = MOST_STRAIN * size
            allowed = f"at most {most:.3g} m either way, {MOST_STRAIN:g} times the side"
            require_number("approach", self.approach, allowed, at_least=-most, at_most=most)

    def _check_start(self, start: Solution) -> None:
        if not isinstance(start, Solution):
            raise InputError("start", start, "a Solution")
        if self.method != "fft" or self.grid is None:
            raise InputError("start", start.status.value, "none but for method fft on a grid")
        grid = self.solve_grid
        finer = any(n < m for n, m in zip(grid.shape, start.grid.shape, strict=True))
        if start.grid.lengths != grid.lengths or finer:
            found = f"{start.grid} elements on {_by(start.grid)} m"
            allowed = f"a solution on at most {grid} elements on {_by(grid)} m"
            raise InputError("start", found, allowed)
        if not start.details.certified:
            raise InputError("start", start.status.value, "a solution whose certificate holds")

    @property
    def solve_grid(self) -> Grid:
        """The grid to solve on; with an accuracy, the one on which the terms are decided."""
        if self.grid is not None:
            return self.scene.grid(self.grid)
        return self.scene.refined(DECISION_GRID * self.scene.slenderness)

    @property
    def target_quantity(self) -> str:
        """The quantity that the accuracy applies to."""
        if self.quantity is not None:
            return self.quantity
        return "contact_area" if is_frictionless(self.scene.friction) else "friction_coefficient_corrected"

    @property
    def residual_tolerance(self) -> float:
        """Tolerance of every residual of the certificate."""
        if self.tolerance is not None:
            return self.tolerance
        if self.method == "paper":
            return PAPER_TOLERANCE
        return 1e-8 if self.accuracy is None else tolerance_for(self.accuracy)

    def plan(self, discretiser: Discretiser | None = None) -> Plan:
        """Return the plan; with an accuracy, the terms for all grids, each checked when its turn comes.

        Raises `InputError` for a grid that does not fit into memory, if possible before heights are sampled.
        """
        grid = self.solve_grid
        if self.grid is not None:
            memory_of(self.method, grid)
        discretiser = discretiser or Discretiser(self.scene, self.approach)
        plan = make_plan(
            discretiser.with_all_terms(grid),
            self.method,
            self.requested,
            demand=self.accuracy or self.residual_tolerance,
            for_mu=self.accuracy is not None and self.target_quantity.startswith("friction_coefficient"),
        )
        return plan if self.grid is None else plan.on(grid)


def _by(grid: Grid) -> str:
    return " x ".join(f"{length}" for length in dict.fromkeys(grid.lengths))
