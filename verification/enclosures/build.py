"""From scenes to proofs: a solver proposes each contact set, ball arithmetic proves it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from verification.enclosures.proof import Proof, prove
from verification.enclosures.scenes import EnclosedScene, near_tie, oblique_scene, scenes

MARGIN = 1e-10
"""By how much a near tie's element misses or makes contact, relative to the approach."""


def proven() -> Iterator[tuple[EnclosedScene, Proof]]:
    """Yield every scene with its proof, one by one."""
    for known in (*scenes(), oblique_scene()):
        yield known, prove_proposed(known)
        if known.name == "rough":
            yield from near_ties(known)


def prove_proposed(known: EnclosedScene) -> Proof:
    """Return the proof of the contact set that the dense reference proposes. Raises `NotProven`."""
    return prove(known, known.solve("dense").contact)


def near_ties(base: EnclosedScene) -> Iterator[tuple[EnclosedScene, Proof]]:
    """Yield the free element nearest to contact, raised until it misses contact, or makes it, by `MARGIN`."""
    proof = prove_proposed(base)
    separations = np.array([float(w) for w in proof.separations])
    nearest = int(separations.argmin())
    i, j = (int(k) for k in np.argwhere(~proof.contact)[nearest])
    margin = MARGIN * float(proof.approach)
    for name, miss in (("near-tie-misses", margin), ("near-tie-touches", -margin)):
        known = near_tie(base, name, (i, j), float(separations[nearest]) - miss)
        contact = proof.contact.copy()
        contact[i, j] = miss < 0
        yield known, prove(known, contact)
