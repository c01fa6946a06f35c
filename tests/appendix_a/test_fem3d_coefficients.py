"""Influence coefficients in 3-D: flat surface, first-order theory, mirror images, stated errors."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import meshio
import numpy as np
import pytest

from appendix_a.fem3d import study
from appendix_a.fem3d.coefficients import Coefficients3D
from appendix_a.fem3d.elasticity import mapped
from appendix_a.fem3d.fields import write_fields
from appendix_a.fem3d.mesh import block
from appendix_a.fem3d.patch import boussinesq, cerruti
from appendix_a.fem3d.space import space
from appendix_a.fem3d.surface import X, Y, outer_displacements, sample, solved
from appendix_a.fem3d.wavy import Waviness
from verification.output.result_files import committed

NU = 0.3


def test_levels_are_one_refinement_family() -> None:
    for wavelength in (16.0, 400.0):
        coarse = block(1.5 * wavelength, wavelength, 1, waves_across=True)
        for level in (2, 3):
            fine = block(1.5 * wavelength, wavelength, level, waves_across=True)
            for axis in ("x", "y", "zeta"):
                kept = getattr(fine, axis)[::level]
                assert kept == pytest.approx(getattr(coarse, axis), abs=1e-9 * wavelength)
            assert set(X) <= set(fine.x)
            assert set(Y) <= set(fine.y)


def test_facet_edges_are_one_unit_of_arc_away() -> None:
    surface = Waviness(30.0, 16.0, 0.2)
    for edge in surface.facet_edges():
        s = np.linspace(0.0, edge, 20001)
        arc = np.hypot(np.diff(s), np.diff(surface.height(s, 0 * s))).sum()  # chords: 1e-9 short
        assert arc == pytest.approx(1.0, abs=1e-7)


def test_mirror_image() -> None:
    """Downhill one way is uphill the other: positions 1/4 and 3/4 change sides, up to the residual."""
    down, up = (sample(Waviness(15.0, 20.0, p), NU, 30.0, 1).down for p in (0.25, 0.75))
    assert down[1:4] == pytest.approx(up[4:7], rel=1e-6)
    assert down[[0, 7, 8, 9]] == pytest.approx(up[[0, 7, 8, 9]], rel=1e-6)


def test_outer_boundary_carries_both_forces() -> None:
    """Far away the element is a point force down and one uphill; 1 % at 30 a is more than a / R squared."""
    surface = Waviness(15.0, 20.0, 0.25)
    body = space(block(30.0, 20.0, 1, waves_across=False))
    held = outer_displacements(body, surface, NU, (-1.0, 1.0)).reshape(3, -1)
    x, y, z = mapped(surface, body.points())
    outer = body.outer_boundary().ravel()
    force = 4.0 * surface.local_slope * np.sinc(2 / 20.0)  # the mean slope over the element
    at = (x[outer], y[outer], z[outer], NU)
    expected = 4.0 * boussinesq(*at) + force * cerruti(*at)
    assert np.abs(held[:, outer] - expected).max() < 0.01 * np.abs(expected).max()
    assert np.all(held[:, ~outer] == 0)


def fake(**_: object) -> Coefficients3D:
    ten = np.arange(10.0)
    return Coefficients3D(ten + 1, ten, ten, ten, ten, 1e-9, 5)


def test_study_continues_a_table_and_stops_on_time(tmp_path: Path) -> None:
    table = tmp_path / "table.json"
    wanted = study.points()
    assert len(wanted) == len(set(wanted))
    assert study.run(table, wanted[:2], 1e9, "made here", fake) == 2
    assert study.run(table, wanted[:3], 1e9, "made here", fake) == 1
    assert study.run(table, wanted, -1.0, "made here", fake) == 0
    written = json.loads(table.read_text())
    assert [line["position"] for line in written["points"]] == [p.position for p in wanted[:3]]
    assert written["labels"][0] == "self"
    assert written["command"] == "made here"
    assert list(tmp_path.iterdir()) == [table]


def test_fields_are_written_through_meshio(tmp_path: Path) -> None:
    """Read back: the volume of half a box under whole waves, and the displacement under the load."""
    surface = Waviness(15.0, 20.0, 0.25)
    body, solution = solved(surface, NU, 30.0, 1)
    path = tmp_path / "body.vtu"
    write_fields(path, body, surface, solution.field)
    mesh = meshio.read(path)
    corners = mesh.points[mesh.cells_dict["hexahedron"]]
    sides = [corners[:, i] - corners[:, 0] for i in (1, 3, 4)]
    volume = np.einsum("ei,ei->e", np.cross(sides[0], sides[1]), sides[2])
    assert np.all(volume > 0)
    assert volume.sum() == pytest.approx(60.0 * 30.0 * 30.0, rel=0.02)  # parallelepipeds for curved cells
    centre = np.argmin(np.linalg.norm(mesh.points - [0.0, 0.0, surface.height(X[:1], Y[:1])[0]], axis=1))
    down = -mesh.point_data["displacement"][centre, 2]
    assert down == pytest.approx(sample(surface, NU, 30.0, 1).down[0], rel=1e-12)


def test_committed_table() -> None:
    """It has all of the study's points, to 0.2 % of flat, and full rows confirm what quick ones state."""
    rows = committed("appendix_a_3d")["points"]
    wanted = {tuple(asdict(p).values()) for p in study.points()}
    names = list(asdict(study.points()[0]))
    best: dict[tuple[object, ...], float] = {}
    by_quality: dict[tuple[object, ...], dict[str, tuple[np.ndarray, np.ndarray]]] = {}
    for line in rows:
        arguments = tuple(line[name] for name in names)
        assert arguments in wanted
        stated = np.add(line["discretisation"], line["truncation"])
        best[arguments[:-1]] = min(best.get(arguments[:-1], 1.0), float(stated.max()))
        by_quality.setdefault(arguments[:-1], {})[str(line["quality"])] = (np.array(line["error"]), stated)
    assert {tuple(line[name] for name in names) for line in rows} == wanted
    assert max(best.values()) < 0.002
    compared = [pair for pair in by_quality.values() if len(pair) == 2]
    assert len(compared) >= 3
    for pair in compared:
        (quick, stated), (full, _) = pair["quick"], pair["full"]
        assert np.all(np.abs(quick - full) <= stated)
