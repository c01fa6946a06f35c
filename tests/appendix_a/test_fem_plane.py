"""Plane and axisymmetric elements: flat boundaries, locking, symmetry, resultants, fields on disk."""

from __future__ import annotations

import meshio
import mpmath as mp
import numpy as np
import pytest

from appendix_a.fem import mixed
from appendix_a.fem.axisymmetric import body_on, circular_patch
from appendix_a.fem.departure import Setup, body_of
from appendix_a.fem.elasticity import lame
from appendix_a.fem.geometry import flat, sinusoid_boundary
from appendix_a.fem.halfplane import pressed_strip
from appendix_a.fem.mesh import Source
from appendix_a.fem.output import element_stresses, write_fields
from appendix_a.fem.result import WavyResult
from appendix_a.fem.wedge_fem import wedge_tip
from appendix_a.leading_order import first_order

NEIGHBOURS = np.array([-20.0, -10.0, -4.0, -3.0, -2.0, 2.0, 3.0, 4.0, 10.0, 20.0])
THREE = np.array([-3.0, -0.5, 2.0, 4.0])
RADII = np.array([0.0, 0.5, 0.9, 1.5, 3.0, 10.0])
OFFSETS = np.array([-10.0, -4.0, -1.0, 0.5, 2.0, 3.0, 10.0])
ENDS = (Source(-1.0, -1.0, 2.0**-7, 1.0), Source(1.0, 1.0, 2.0**-7, 1.0))


def flat_error(order, level, nu, solve=None):
    """Largest relative error of surface displacements, relative to the centre's."""
    body = body_of(Setup(ENDS, 1024.0, order), level, flat())
    u = body.displacements(nu) if solve is None else solve(body, nu)
    points = np.append(OFFSETS, 0.0)
    error = body.surface_values(u[1] - pressed_strip(body.basis.doflocs[0], nu), points)
    return np.max(np.abs((error[:-1] - error[-1]) / pressed_strip(OFFSETS, nu)))


def test_nearly_incompressible_body_does_not_lock():
    # locking would leave an error that refinement does not remove: cubics, cells halved (third order: 8)
    assert flat_error(3, 3, 0.4999) < flat_error(3, 1, 0.4999) / 5
    assert flat_error(3, 3, 0.4999) < 1e-4  # measured 3.6e-5, and 1.4e-5 at nu = 0.3
    # the mixed formulation shares mesh and far field and nothing of the stiffness
    assert flat_error(2, 3, 0.4999, mixed.displacements) < 3e-4  # measured 1.8e-4, and 3.1e-4 at nu = 0.3


def test_load_is_the_pressure_s_resultant_on_a_steep_wave():
    boundary = sinusoid_boundary(30.0, 12.0, 0.2, 24.0)
    body = body_of(Setup((*ENDS, Source(-24.0, 24.0, 2.0, 1.0)), 256.0), 1, boundary)
    rise = np.diff(boundary.height(np.array([boundary.left, boundary.right])))[0]
    # inward normal times length: (-dy, dx) integrates to the chord, exactly on any interpolated curve
    assert body.load.sum(axis=1) == pytest.approx([-rise, boundary.right - boundary.left], abs=1e-12)


def test_uniform_strain_is_reproduced_on_curved_elements():
    """Patch test: nodal values of a linear field give its constant stresses and no inner nodal force."""
    setup = Setup((*ENDS, Source(-24.0, 24.0, 2.0, 1.0)), 64.0)
    body = body_of(setup, 0, sinusoid_boundary(30.0, 12.0, 0.2, 24.0))
    x, y = body.basis.doflocs
    u = np.array([0.3 * x + 0.1 * y, -0.2 * x + 0.5 * y])
    lam, mu = lame(0.3)
    expected = {"sigma_xx": lam * 0.8 + 0.6 * mu, "sigma_yy": lam * 0.8 + mu, "sigma_xy": -0.1 * mu}
    for name, values in element_stresses(body, 0.3, u).items():
        assert values == pytest.approx(expected[name], abs=1e-11)  # coordinates of 64 over cells of 2^-7
    inner = np.setdiff1d(np.arange(body.basis.N), body.nodes_of(body.mesh.boundary_facets()))
    assert np.abs((body.stiffness(0.3) @ u.ravel()).reshape(2, -1)[:, inner]).max() < 1e-11


def test_fields_on_disk_are_those_of_the_solve(tmp_path):
    body = body_of(Setup(ENDS, 64.0), 0, flat())
    u = body.displacements(0.3)
    write_fields(tmp_path / "flat.vtu", body, 0.3, u)
    stored = meshio.read(tmp_path / "flat.vtu")
    vertex = int(body.surface[3])
    corner = body.mesh.facets[0, vertex]
    assert stored.points[corner, :2] == pytest.approx(body.mesh.doflocs[:, corner], abs=1e-15)
    node = body.basis.dofs.nodal_dofs[0, corner]
    assert stored.point_data["displacement"][corner, :2] == pytest.approx(u[:, node], abs=1e-14)
    under = stored.points[stored.cells_dict["triangle6"][:, :3]].mean(axis=1)
    middle = np.argmin(np.hypot(under[:, 0], under[:, 1]))
    # the exact stress at that depth is -1 to its square; the coarse mesh gives two digits
    assert stored.cell_data["sigma_yy"][0][middle] == pytest.approx(-1.0, abs=0.05)


@pytest.mark.nightly
def test_wedge_tip_is_symmetric_and_of_first_order_where_the_formula_says():
    found = wedge_tip(2.5, 8.0, 0.3, offsets=NEIGHBOURS)
    assert found.wavy == pytest.approx(found.wavy[::-1], abs=1e-9)
    tangent = np.tan(np.radians(2.5))
    first = first_order(lambda x: tangent * np.abs(x), NEIGHBOURS, 0.3)
    assert np.abs(found.wavy - found.flat - first).max() < 3 * tangent**2  # second order; measured 2.4 tan^2
    assert found.discretisation_error < 1e-4 * np.abs(found.flat).min()


def test_patch_formula_against_quadrature_of_chords():
    """In polar coordinates about the field point, the integral of 1 / distance is that of chord lengths."""
    for r in (0.0, 0.5, 2.5):
        sight = mp.pi / 2 if r <= 1 else mp.asin(1 / mp.mpf(r))
        half = mp.quad(lambda angle, r=r: 2 * mp.re(mp.sqrt(1 - (r * mp.sin(angle)) ** 2)), [0, sight])
        # E = 1, nu = 0; an inverse-root derivative at the end costs tanh-sinh nothing
        assert circular_patch(np.array([r]), 0.0)[0] == pytest.approx(float(2 * half / mp.pi), rel=1e-12)


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_flat_patch(nu):
    errors = []
    for level in (0, 3):
        body = body_on(flat(), 8.0, 512.0, level)
        u = body.displacements(nu)[1] - circular_patch(body.basis.doflocs[0], nu)
        errors.append(np.max(np.abs(body.surface_values(u, RADII) / circular_patch(RADII, nu))))
    assert errors[1] < 3e-5  # measured 1.5e-5
    assert errors[1] < errors[0] / 8  # cells halved, fans finer: third order and more


def test_errors_of_meshes_and_radii() -> None:
    """Changes 4 and 1 (ratio 1/4, index 1.25 / 3) and one offset that the last mesh does not notice."""
    flat = np.array([10.0, 0.0, -20.0])
    meshes = [np.array([5.0, 2.0, 0.0]), np.array([1.0, 2.5, 0.0]), np.array([0.0, 2.5, 0.0])]
    radii = [np.array([0.0, 0.0, 9.0]), np.array([0.5, 0.0, 1.0]), np.array([0.25, 0.125, 1.0])]
    found = WavyResult.of(THREE[:3], flat, meshes, radii)
    factor = 1.25 * 0.25 / 0.75
    assert found.mesh_error == pytest.approx([factor * 2.0, factor * 0.25, 0.0])  # half of the change before
    assert found.truncation_error == pytest.approx([0.25, 0.125, 0.0])
    assert found.discretisation_error == pytest.approx(factor * 2.0 + 0.25)
    assert found.wavy == pytest.approx([10.0, 2.5, -20.0])
    assert found.mesh_values[0] == pytest.approx([15.0, 2.0, -20.0])
    percent = found.percentage_points
    assert percent[0] == pytest.approx(10 * (factor * 2.0 + 0.25))
    assert np.isnan(percent[1])
    assert percent[2] == 0.0
