"""Plane strain under a flat boundary: exact values, observed order, resultants, locking; fields on disk."""

import meshio
import numpy as np
import pytest

from appendix_a.fem import mixed
from appendix_a.fem.departure import Setup, body_of
from appendix_a.fem.elasticity import lame
from appendix_a.fem.geometry import flat, sinusoid_boundary
from appendix_a.fem.halfplane import pressed_strip
from appendix_a.fem.mesh import Source
from appendix_a.fem.output import element_stresses, write_fields

OFFSETS = np.array([-10.0, -4.0, -1.0, 0.5, 2.0, 3.0, 10.0])
ENDS = (Source(-1.0, -1.0, 2.0**-7, 1.0), Source(1.0, 1.0, 2.0**-7, 1.0))


def flat_error(order, level, nu, solve=None):
    """Largest relative error of surface displacements, relative to the centre's."""
    body = body_of(Setup(ENDS, 1024.0, order), level, flat())
    u = body.displacements(nu) if solve is None else solve(body, nu)
    points = np.append(OFFSETS, 0.0)
    error = body.surface_values(u[1] - pressed_strip(body.basis.doflocs[0], nu), points)
    return np.max(np.abs((error[:-1] - error[-1]) / pressed_strip(OFFSETS, nu)))


def test_quadratic_elements_converge_at_their_order():
    errors = [flat_error(2, level, 0.3) for level in (1, 3, 5)]  # cells halved each time
    # O(h^3) in the displacement with quadratics and better at vertices; 0.5 for pre-asymptotic meshes
    assert np.all(np.log2(np.array(errors[:-1]) / errors[1:]) > 1.5)
    assert np.log2(errors[0] / errors[2]) / 2 > 2.2


def test_flat_boundary_to_1e_5():
    assert flat_error(4, 3, 0.3) < 1e-5


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
