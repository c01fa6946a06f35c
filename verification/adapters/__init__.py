"""Published contact solvers under test: Tamaas, ContactMechanics and ASPHER, each an optional extra.

Every adapter has a ``solve``: ``rough-friction verify --solver verification.adapters.tamaas:solve``. It sets
the peer up as its own documentation recommends and changes only units and signs.
"""
