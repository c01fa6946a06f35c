"""Cases of roughness: other codes on the same heights, where they are installed; what the cases measure."""

from __future__ import annotations

from pathlib import Path

import pytest

from verification.adapters import contactmechanics, tamaas
from verification.adapters.published_code import PublishedCode
from verification.cases.contact import lay, self_affine
from verification.sweep.engine import sweep
from verification.sweep.study_file import study_from_dict

PUBLISHED = [
    pytest.param(
        peer,
        id=peer.extra,
        marks=pytest.mark.skipif(peer.installed is None, reason=f"{peer.distribution} is not installed"),
    )
    for peer in (tamaas.solve, contactmechanics.solve)
]


@pytest.mark.parametrize("peer", PUBLISHED)
def test_other_codes_find_the_same_pressures(peer: PublishedCode) -> None:
    assert self_affine.agreement(peer).value < 1e-6  # of the peak; measured 4e-12


def test_weak_roughness_pulls_as_its_first_order_does() -> None:
    force, first_order = lay.weak_forces(seed=2, direction=0.3)
    assert force == pytest.approx(first_order, rel=0.05)  # 4 nm on an indentation of 1.2 um; measured 1 %


def test_realisations_of_self_affine_surfaces(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text("""
load = 2.0
side = 1e-3
[upper.material]
E = 200e9
nu = 0.30
[[upper.surface]]
kind = "sphere"
radius = 0.05
[lower.material]
E = 118e9
nu = 0.30
[[lower.surface]]
kind = "self_affine"
hurst = 0.8
rms_gradient = 0.01
roll_off = 2e-4
long_cut = 4e-4
short_cut = 5e-5
seed = 1
[friction]
beta = 0.1
""")
    study = study_from_dict({"scene": "scene.toml", "realisations": 2, "vary": {"grid": [32]}}, tmp_path)
    found = sweep(study, tmp_path / "store.sqlite", workers=0)
    assert [row["status"] for row in found.rows] == ["converged", "converged"]
    assert found.rows[0]["contact_area"] != found.rows[1]["contact_area"]
