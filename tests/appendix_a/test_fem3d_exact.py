"""Exact fields of the flat half-space and first-order theory, against quadrature and elasticity itself."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from appendix_a.fem3d import patch
from appendix_a.fem3d.leading_order import GAUSS, far_part, wave_kernel
from appendix_a.fem3d.surface import X, Y
from appendix_a.fem3d.wavy import Kind, Waviness
from refimpl import kernels

NU = 0.3
SHEAR, LAME = 0.5 / (1 + NU), NU / ((1 + NU) * (1 - 2 * NU))
Field = Callable[[np.ndarray], np.ndarray]


def one(value: float) -> np.ndarray:
    return np.array([value])


def test_integrals_over_the_patch_are_the_models() -> None:
    """`refimpl.kernels` is held to 50 digits by its cases; oblong patches are for a tilted plane."""
    x, y = np.array([0.0, 2.0, -4.0]), np.array([0.0, 0.0, 1.5])
    for half_x in (1.0, 0.9):
        expected = kernels.normal_integral(x, y, 2 * half_x, 2.0)
        np.testing.assert_allclose(patch.normal_integral(x, y, half_x), expected, rtol=1e-12)
        expected = kernels.tangential_integral(x, y, 2 * half_x, 2.0)
        np.testing.assert_allclose(patch.tangential_integral(x, y, half_x), expected, rtol=1e-12, atol=1e-15)


def gradient(field: Field, at: np.ndarray) -> np.ndarray:
    """du_i/dx_j (3, 3, n) by fourth-order differences; rounding and step leave about 1e-10."""
    step = 1e-3
    columns = []
    for j in range(3):
        e = np.zeros((3, 1))
        e[j] = step
        near, far = field(at + e) - field(at - e), field(at + 2 * e) - field(at - 2 * e)
        columns.append((8 * near - far) / (12 * step))
    return np.stack(columns, axis=1)


def stress(field: Field, at: np.ndarray) -> np.ndarray:
    g = gradient(field, at)
    trace = np.einsum("iin->n", g)
    return SHEAR * (g + np.swapaxes(g, 0, 1)) + LAME * np.eye(3)[:, :, None] * trace


@pytest.mark.parametrize(
    ("field", "force"),
    [(patch.boussinesq, (0.0, 0.0, -1.0)), (patch.cerruti, (1.0, 0.0, 0.0))],
    ids=["boussinesq", "cerruti"],
)
def test_point_force_leaves_the_surface_free_and_is_carried_by_a_hemisphere(
    field: Callable[..., np.ndarray], force: tuple[float, float, float]
) -> None:
    def displaced(p: np.ndarray) -> np.ndarray:
        return field(p[0], p[1], p[2], NU)

    surface_points = np.array([[1.0, -0.7, 0.3], [0.5, 0.9, -1.2], [0.0, 0.0, 0.0]])
    assert np.abs(stress(displaced, surface_points)[:, 2]).max() < 1e-9

    cosines, weights = np.polynomial.legendre.leggauss(12)
    cosines, weights = 0.5 * (cosines - 1), 0.5 * weights  # z from -1 to 0 on the unit sphere
    angles = 2 * np.pi * np.arange(12) / 12
    z, phi = (c.ravel() for c in np.meshgrid(cosines, angles, indexing="ij"))
    normal = np.array([np.sqrt(1 - z * z) * np.cos(phi), np.sqrt(1 - z * z) * np.sin(phi), z])
    area = np.repeat(weights, 12) * 2 * np.pi / 12
    carried = np.einsum("ijn,jn,n->i", stress(displaced, normal), normal, area)
    # 12 x 12 points; differences leave 1e-10
    assert carried + np.array(force) == pytest.approx(np.zeros(3), abs=1e-8)


def test_far_field_joins_the_surface_coefficients() -> None:
    """At z = 0 and 24 a, Gauss point forces against the closed forms of the patch."""
    nodes, weights = np.polynomial.legendre.leggauss(4)
    sources = np.stack([c.ravel() for c in np.meshgrid(nodes, nodes, indexing="ij")], axis=1)
    area = np.outer(weights, weights).ravel()
    x, y = np.array([24.0, -20.0, 3.0]), np.array([0.0, 14.0, 25.0])
    points = np.stack([x, y, np.zeros(3)])
    pressed = patch.far_field(points, np.stack([0 * area, area], axis=1), sources, NU)
    dragged = patch.far_field(points, np.stack([area, 0 * area], axis=1), sources, NU)
    assert -pressed[2] == pytest.approx(patch.normal_coefficient(x, y, NU), rel=1e-11)
    assert -dragged[2] == pytest.approx(patch.tangential_coefficient(x, y, NU), rel=1e-11)


def test_tilted_plane_is_the_facet_prediction_to_second_order() -> None:
    """Their difference is of second order in the slope, its antisymmetric part of third."""
    slopes = np.array([0.5, 1.0, 2.0])
    gaps = [
        patch.tilted_plane(X, Y, NU, s, projected=True) - patch.facet_prediction(X, Y, NU, s) for s in slopes
    ]
    worst = [np.abs(gap).max() for gap in gaps]
    assert worst[1] / worst[0] == pytest.approx(4.0, rel=1e-2)
    antisymmetric = [np.abs(gap[1:4] - gap[4:7]).max() for gap in gaps]
    assert antisymmetric[2] / antisymmetric[1] == pytest.approx(8.0, rel=1e-2)


def test_wave_kernel_against_its_double_integral() -> None:
    """The residues themselves: sin^2 of the angle summed over both wavenumbers, Gaussian sources of width w.

    The source's transform exp(-w^2 q^2 / 2) makes the double sum converge and costs w^2, which two widths
    remove: w^4 and the step in q leave less than 1 %.
    """
    k, step = 0.5, 0.025
    q = (np.arange(-600, 600) + 0.5) * step
    kx, ky = np.meshgrid(q, q, indexing="ij")
    squared = kx**2 + ky**2
    sine2 = k * k * ky**2 / (squared * ((kx + k) ** 2 + ky**2)) * (step / (2 * np.pi)) ** 2
    narrow, wide = np.exp(-0.5 * 0.09 * squared), np.exp(-0.5 * 0.18 * squared)
    for x, y in ((2.0, 0.0), (-2.0, 0.0), (0.0, 2.0), (2.0, 2.0)):
        wave = np.exp(1j * (kx * x + ky * y + k * x))
        expected = np.sum(sine2 * (2 * narrow - wide) * wave)
        assert complex(wave_kernel(one(x), one(y), k)[0]) == pytest.approx(complex(expected), rel=0.01)


def test_far_part_is_settled_and_vanishes_with_long_waves(monkeypatch: pytest.MonkeyPatch) -> None:
    kind = Kind.EGG_BOX
    surface = Waviness(1.0, 20.0, 0.1, kind)
    coarse = far_part(surface, X, Y, NU)
    monkeypatch.setattr("appendix_a.fem3d.leading_order.GAUSS", 2 * GAUSS)
    scale = np.abs(coarse).max()
    assert np.abs(far_part(surface, X, Y, NU) - coarse).max() < 1e-3 * scale
    assert np.abs(far_part(Waviness(1.0, 1e5, 0.1, kind), X, Y, NU)).max() < 1e-2 * scale
    assert np.abs(far_part(surface, X, Y, 0.5)).max() == 0.0
