"""Surfaces: shapes, Gaussian (Eq. 9) and self-affine roughness, measured heights, arrays and their sums."""

from refimpl.surfaces.from_table import surface_from_dict
from refimpl.surfaces.gaussian import GaussianRoughness
from refimpl.surfaces.inspection import Inspection, inspect
from refimpl.surfaces.measured import MeasuredSurface
from refimpl.surfaces.self_affine import SelfAffineRoughness
from refimpl.surfaces.shapes import Flat, Sphere
from refimpl.surfaces.surface import ArraySurface, Surface, SurfaceSum, SurfaceWarning, as_surface

__all__ = [
    "ArraySurface",
    "Flat",
    "GaussianRoughness",
    "Inspection",
    "MeasuredSurface",
    "SelfAffineRoughness",
    "Sphere",
    "Surface",
    "SurfaceSum",
    "SurfaceWarning",
    "as_surface",
    "inspect",
    "surface_from_dict",
]
