"""Published contact solvers under test: Tamaas, ContactMechanics, ASPHER and SlipPY, by their short names.

An adapter sets the peer up as its documentation recommends, and changes only units and signs
(docs/check-your-solver.md).
"""

NAMES = ("tamaas", "contactmechanics", "aspher", "slippy")
PUBLISHED = {name: f"verification.adapters.{name}:solve" for name in NAMES}
"""Solvers under test by their short names."""
