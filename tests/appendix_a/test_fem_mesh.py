"""Graded triangulations: conforming, filling, graded, symmetric."""

import numpy as np
import pytest

from appendix_a.fem.mesh import Source, graded_mesh

ENDS = (Source(-1.0, -1.0, 2.0**-6, 1.0), Source(1.0, 1.0, 2.0**-6, 1.0))
WAVES = (*ENDS, Source(-24.0, 24.0, 0.9, 0.5))


def signed_areas(mesh):
    a, b, c = (mesh.p[:, mesh.t[k]] for k in range(3))
    return ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2


@pytest.mark.parametrize("sources", [ENDS, WAVES])
@pytest.mark.parametrize("centred", [True, False])
@pytest.mark.parametrize("quadrant", [True, False])
def test_triangles_fill_the_outline_without_gaps_or_hanging_vertices(sources, centred, quadrant):
    mesh = graded_mesh(sources, 64.0, centred=centred, quadrant=quadrant)
    total = 64.0**2 * (1 if quadrant else 2)
    assert np.abs(signed_areas(mesh)).sum() == total  # dyadic coordinates: exact in binary
    middle = mesh.p[:, mesh.facets[:, mesh.boundary_facets()]].mean(axis=1)
    left = 0.0 if quadrant else -64.0
    on_outline = (middle[0] == left) | (middle[0] == 64.0) | (middle[1] == 0.0) | (middle[1] == 64.0)
    assert on_outline.all()  # a facet with one triangle inside the body would be a crack


@pytest.mark.parametrize("centred", [True, False])
def test_cells_obey_the_sources_and_meet_the_strip_ends(centred):
    mesh = graded_mesh(WAVES, 64.0, centred=centred)
    assert {(-1.0, 0.0), (1.0, 0.0)} <= set(map(tuple, mesh.p.T.tolist()))
    corners = mesh.p[:, mesh.t]
    size = np.ptp(corners, axis=1).max(axis=0)
    low, high = corners.min(axis=1), corners.max(axis=1)
    for source in WAVES:
        apart = np.maximum(np.maximum(source.left - high[0], low[0] - source.right), 0.0)
        allowed = np.maximum(source.size, source.growth * np.hypot(apart, low[1]))
        # a triangle of a fan may lie half a cell farther off than its cell: one cell's size of slack
        assert np.all(size <= allowed + source.growth * size)
