"""From scenes to proofs: a solver proposes each contact set, ball arithmetic proves it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from verification.golden.enclosure import Proof, prove
from verification.golden.scenes import GoldenScene, near_tie, oblique_scene, scenes

MARGIN = 1e-10
"""By how much a near tie's element misses or makes contact, relative to the approach."""


def proven() -> Iterator[tuple[GoldenScene, Proof]]:
    """Every golden scene with its proof, one by one."""
    for golden in (*scenes(), oblique_scene()):
        yield golden, prove_proposed(golden)
        if golden.name == "rough":
            yield from near_ties(golden)


def prove_proposed(golden: GoldenScene) -> Proof:
    """Proof of the contact set that the dense reference proposes. Raises `NotProven`."""
    return prove(golden, golden.solve("dense").contact)


def near_ties(base: GoldenScene) -> Iterator[tuple[GoldenScene, Proof]]:
    """The free element nearest to contact, raised until it misses contact, or makes it, by `MARGIN`."""
    proof = prove_proposed(base)
    separations = np.array([float(w) for w in proof.separations])
    nearest = int(separations.argmin())
    i, j = (int(k) for k in np.argwhere(~proof.contact)[nearest])
    margin = MARGIN * float(proof.approach)
    for name, miss in (("near-tie-misses", margin), ("near-tie-touches", -margin)):
        golden = near_tie(base, name, (i, j), float(separations[nearest]) - miss)
        contact = proof.contact.copy()
        contact[i, j] = miss < 0
        yield golden, prove(golden, contact)
