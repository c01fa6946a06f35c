"""Published contact solvers under test: Tamaas, ContactMechanics, ASPHER and SlipPY.

Each is run by a short name, as in ``rough-friction verify --solver tamaas``. What each needs stands in
docs/check-your-solver.md. An adapter sets the peer up as its own documentation recommends and changes only
units and signs.
"""

NAMES = ("tamaas", "contactmechanics", "aspher", "slippy")
PUBLISHED = {name: f"verification.adapters.{name}:solve" for name in NAMES}
"""Solvers under test by their short names."""
