"""Reference implementation of a numerical model of friction between rough surfaces (2001).

>>> steel, copper = Material(E=200e9, nu=0.30), Material(E=118e9, nu=0.30)
>>> scene = Scene(
...     upper=Body(steel, Sphere(radius=0.14)), lower=Body(copper, Flat()),
...     friction=Friction(tau=15e6, beta=0.08), load=70.0, side=1.61e-3)
>>> s = solve(scene, grid=64)
>>> s.status.name, round(s.friction_coefficient, 3)
('CONVERGED', 0.217)
"""

from refimpl.driver.solve import solve
from refimpl.errors import Error, InputError, NotConverged
from refimpl.grid import Grid
from refimpl.measured import Inspection, MeasuredSurface, inspect_surface
from refimpl.model.friction import Friction, FrictionLaw
from refimpl.model.materials import Material
from refimpl.model.state import Status
from refimpl.scene.scene import Body, Scene
from refimpl.scene.scene_file import read_scene, scene_to_toml, shipped_scenes
from refimpl.sensitivities.sensitivity import Sensitivity, sensitivity
from refimpl.solution.solution import Solution
from refimpl.surfaces import (
    ArraySurface,
    Flat,
    GaussianRoughness,
    SelfAffineRoughness,
    Sphere,
    Surface,
    SurfaceSum,
    SurfaceWarning,
)

__version__ = "0.1.0"  # the one place that states it

__all__ = [
    "ArraySurface",
    "Body",
    "Error",
    "Flat",
    "Friction",
    "FrictionLaw",
    "GaussianRoughness",
    "Grid",
    "InputError",
    "Inspection",
    "Material",
    "MeasuredSurface",
    "NotConverged",
    "Scene",
    "SelfAffineRoughness",
    "Sensitivity",
    "Solution",
    "Sphere",
    "Status",
    "Surface",
    "SurfaceSum",
    "SurfaceWarning",
    "inspect_surface",
    "read_scene",
    "scene_to_toml",
    "sensitivity",
    "shipped_scenes",
    "solve",
]
