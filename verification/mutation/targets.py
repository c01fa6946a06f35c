"""The modules that are mutated, and the tests that judge each: its own first, the invariants last.

A kill-suite takes seconds, so slow tests that add nothing to it (50-digit sweeps over many elements, files,
command lines) stay out. Suites run in the order they are written and end at the first failure.
"""

from __future__ import annotations

from typing import NamedTuple

INVARIANTS = tuple(
    f"tests/verification/properties/test_properties.py::test_invariant[{name}-{solver}]"
    for name in (
        "displacements", "load_balance", "complementarity", "local_friction_law", "area_and_peak",
        "agrees_with_the_dense_reference", "load_and_approach", "quarter_turn",
    )
    for solver in ("dense", "fft")
)  # fmt: skip
"""Invariants that recompute a state by other means, or turn it: all 25 would take three times as long."""
KERNELS = tuple(f"tests/refimpl/test_{name}.py" for name in ("kernels_properties", "kernels", "multipole"))
OPERATORS = (
    "tests/refimpl/operators/test_operators.py",
    "tests/refimpl/solvers/production/test_flexibility.py",
    *INVARIANTS,
)
WEDGE = ("tests/appendix_a/test_wedge.py", "tests/appendix_a/test_wedge_enclosure.py")
STRIP = ("tests/appendix_a/test_strip.py",)


class Target(NamedTuple):
    """``module`` (a path) of ``subject``, and paths of the tests that judge it beside its doctests."""

    subject: str
    module: str
    tests: tuple[str, ...]

    @property
    def files(self) -> tuple[str, ...]:
        """The files that hold the tests."""
        return tuple(dict.fromkeys(test.partition("::")[0] for test in self.tests))

    @property
    def suite(self) -> tuple[str, ...]:
        """Arguments for pytest."""
        return (self.module, *self.tests)


def _alone(*names: str) -> tuple[str, ...]:
    return tuple(f"tests/refimpl/test_{name}.py" for name in names)


def _tests(*names: str) -> tuple[str, ...]:
    return (*_alone(*names), *INVARIANTS)


PRIORS = "tests/verification/coverage/test_priors.py::test_the_priors_in_use_are_those_of_the_committed_study"
BARS = ("estimate", "accuracy_summits", "accuracy_climb", "unevenness", "first_touch", "accuracy_estimates")
REFUSED = "tests/refimpl/scene/test_input.py::test_refused_by_one_line_that_names_the_field"
SURFACES = _alone("surfaces", "surfaces_statistics", "surfaces_gaussian", "surfaces_measured")


TARGETS = (
    *(Target("wedge", f"appendix_a/wedge/{name}.py", WEDGE)
      for name in ("__init__", "enclosure", "fast", "printed", "reference", "residues", "transform")),
    *(Target("strip", f"appendix_a/strip/{name}.py", STRIP)
      for name in ("field", "perturbation", "profile", "superposition")),
    *(Target("kernels", f"refimpl/kernels/{name}.py", KERNELS)
      for name in ("cerruti", "far_field", "love", "multipole", "points", "tables")),
    *(Target("operators", f"refimpl/operators/{name}.py", OPERATORS)
      for name in ("dense", "periodic", "tables", "fft", "window")),
    *(Target("operators", f"refimpl/operators/{name}.py",
             ("tests/refimpl/operators/test_transforms.py", "tests/refimpl/operators/test_operators.py"))
      for name in ("fourier", "symmetric")),
    Target("contact", "refimpl/solvers/pivoting.py", _tests("active_set", "dense_solver")),
    Target("contact", "refimpl/model/certificate.py", _tests("certificate", "solve")),
    Target("friction", "refimpl/model/friction.py", _tests("friction", "tau_cycle")),
    Target("equilibrium", "refimpl/model/problem.py", _tests("problem")),
    Target("equilibrium", "refimpl/model/forces.py", _tests("forces")),
    Target("equilibrium", "refimpl/model/slopes.py", _tests("slopes")),
    Target("equilibrium", "refimpl/solvers/dense.py", _tests("dense_solver", "tau_cycle", "solve")),
    Target("equilibrium", "refimpl/solvers/paper.py",
           ("tests/refimpl/solvers/test_paper_scheme.py", "tests/refimpl/solvers/test_paper.py")),
    Target("contact", "refimpl/operators/preconditioner.py", _tests("preconditioner", "projected_cg")),
    Target("contact", "refimpl/operators/extension.py", ("tests/refimpl/operators/test_extension.py",)),
    Target("contact", "refimpl/solvers/production/projected_cg.py",
           _tests("projected_cg", "projected_cg_steps", "solve")),
    Target("contact", "refimpl/model/gap.py", _tests("projected_cg")),
    Target("contact", "refimpl/solvers/production/step_length.py", _tests("cut", "projected_cg", "projected_cg_steps")),
    Target("contact", "refimpl/solvers/production/contact_vectors.py", _tests("support", "projected_cg", "projected_cg_steps")),
    Target("equilibrium", "refimpl/grid/grid.py", _tests("grid", "nesting", "input", "projected_cg", "solve")),
    Target("equilibrium", "refimpl/solvers/production/coarse_grids.py", _tests("nesting", "start", "solve")),
    Target("equilibrium", "refimpl/solvers/production/flexibility.py", _tests("flexibility", "level_updates")),
    Target("equilibrium", "refimpl/solvers/tau_active_set.py", _tests("tau_path", "tau_cycle")),
    Target("equilibrium", "refimpl/solvers/production/anderson.py", _alone("mixing", "fft_solver")),
    Target("equilibrium", "refimpl/solvers/production/updates.py", _alone("updates", "level_solver", "fft_solver")),
    Target("equilibrium", "refimpl/solvers/production/nested_solver.py",
           _tests("fft_solver", "level_updates", "start", "solve", "solve_full_contact", "tau_cycle")),
    Target("equilibrium", "refimpl/solvers/production/lagged_terms.py", _tests("level_updates", "level_solver", "fft_solver", "solve")),
    Target("equilibrium", "refimpl/solvers/production/level.py",
           _tests("level_solver", "level_updates", "fft_solver", "solve", "solve_full_contact", "tau_cycle")),
    Target("error bars", "refimpl/solution/gathered.py", _alone("solve", "accuracy", "tau_cycle", "plan")),
    Target("error bars", "refimpl/accuracy/bayesian_line.py", _alone(*BARS)),
    Target("error bars", "refimpl/accuracy/discretisation_error.py", (PRIORS, *_alone(*BARS))),
    Target("error bars", "refimpl/accuracy/grid_features.py", _alone("summit", *BARS)),
    Target("error bars", "refimpl/grid/contact_patches.py", _alone("spots")),
    Target("error bars", "refimpl/accuracy/peak.py", _alone("summit", *BARS)),
    Target("error bars", "refimpl/accuracy/first_contact.py", _alone("first_touch", *BARS)),
    Target("error bars", "refimpl/accuracy/iteration_error.py", _alone("accuracy", *BARS)),
    Target("error bars", "refimpl/accuracy/refinement.py", _alone("accuracy_climb", "accuracy", "accuracy_estimates")),
    Target("error bars", "refimpl/solution/influence_error.py", _alone("coefficient_error", "plan_validity")),
    Target("error bars", "refimpl/solution/influence_error_3d.py", _alone("element_error")),
    Target("bounds", "refimpl/solution/bounds.py", _alone("bounds_derivation", "bounds")),
    Target("bounds", "refimpl/solution/energy_norm.py",
           _alone("energy_norm", "bounds_derivation", "bounds", "preconditioner")),
    Target("sensitivity", "refimpl/sensitivities/fixed_contact.py", _alone("fixed_set", "sensitivity", "sensitivity_refusals")),
    Target("sensitivity", "refimpl/sensitivities/edge_motion.py", _alone("edge_motion", "sensitivity")),
    Target("sensitivity", "refimpl/sensitivities/sensitivity.py", _alone("sensitivity", "sensitivity_refusals")),
    Target("sensitivity", "refimpl/scene/parameters.py", _alone("sensitivity")),
    Target("sensitivity", "refimpl/sensitivities/budget.py", _alone("sensitivity_budget", "sensitivity_refusals")),
    *(Target("surfaces", f"refimpl/surfaces/{name}.py", SURFACES)
      for name in ("bicubic", "gaps", "gaussian", "levelling", "measured", "noise", "shapes", "statistics",
                   "window")),
    Target("surfaces", "refimpl/model/materials.py",
           (*_alone("materials"), REFUSED)),
)  # fmt: skip
"""What the mutation score speaks of."""
