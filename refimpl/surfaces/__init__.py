"""Surfaces that are made: shapes, Gaussian (Eq. 9) and self-affine roughness, arrays and sums of them."""

from refimpl.surfaces.from_table import surface_from_dict
from refimpl.surfaces.gaussian import GaussianRoughness
from refimpl.surfaces.self_affine import SelfAffineRoughness
from refimpl.surfaces.shapes import Flat, Sphere
from refimpl.surfaces.surface import ArraySurface, Surface, SurfaceSum, SurfaceWarning, as_surface

__all__ = [
    "ArraySurface",
    "Flat",
    "GaussianRoughness",
    "SelfAffineRoughness",
    "Sphere",
    "Surface",
    "SurfaceSum",
    "SurfaceWarning",
    "as_surface",
    "surface_from_dict",
]
