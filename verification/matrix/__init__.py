"""Which check sees which fault: quick checks against seeded faults (``python -m verification.matrix``)."""
