"""The suite's cases, by subject; `verification.solver_suite.suite` imports every module of this package."""
