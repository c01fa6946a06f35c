"""The suite's cases, by subject; `verification.contestants.suite` imports every module of this package."""
