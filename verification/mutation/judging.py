"""Modules that judge - cases, contestants, error bars, codes - or report: where a false pass would hide.

Exact solutions and the cases themselves are not among them: they are judged by the quick tier, which
`make test` runs.
"""

from __future__ import annotations

from verification.mutation.targets import Target


def _of(subject: str, folder: str, names: str, *tests: str) -> tuple[Target, ...]:
    return tuple(Target(subject, f"{folder}/{name}.py", tests) for name in names.split())


def _tests(folder: str, names: str) -> tuple[str, ...]:
    return tuple(f"tests/{folder}/test_{name}.py" for name in names.split())


CONTESTANTS = _tests("verification", "contestants contestants_suite contestants_beds contestants_margins")
COVERAGE = _tests("verification", "coverage_judge coverage coverage_priors")
REPORTS = _tests(
    "reports",
    "evidence generator comparison exhibit contestant fault_matrix drawing peer_exhibits coverage_exhibits",
)

JUDGES = (
    *_of("cases", "verification", "case runner registry workers",
         *_tests("verification", "case runner registry")),
    *_of("cases", "verification", "rates", *_tests("verification", "rates")),
    *_of("contestants", "verification/contestants", "referee check asking beds protocol", *CONTESTANTS),
    *_of("contestants", "verification/contestants/checks",
         "area exact invariance memory periodic residuals sliding sliding_pins smooth wide", *CONTESTANTS),
    *_of("error bars", "verification/coverage", "judge beside document priors store", *COVERAGE),
    *_of("benchmarks", "verification/benchmarks", "judge rounds run summary",
         *_tests("verification", "benchmarks")),
    *_of("ensembles", "verification/multilevel", "ensemble estimator",
         *_tests("verification", "multilevel multilevel_estimator multilevel_refusals")),
    *_of("extremes", "verification/extremes",
         "judge oracle state limits exact_operators positive_definite uniqueness conditioning",
         *_tests("verification", "extremes")),
    *_of("prices", "verification/tradeoff", "measure prices settings study",
         *_tests("verification", "tradeoff")),
    *_of("reports", "reports",
         "comparison contestant evidence exhibit generator results summary traceability", *REPORTS),
)  # fmt: skip
"""What the judges' own score speaks of."""
