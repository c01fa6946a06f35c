"""A solution's fields with names, units and coordinates, for array files and for xarray."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from refimpl.errors import InputError
from refimpl.grid.contact_patches import patch_labels
from refimpl.solution.reported import Reported

UNITS = {
    "friction_coefficient_corrected": "1",
    "friction_coefficient": "1",
    "contact_area": "m^2",
    "contact_area_corrected": "m^2",
    "contact_area_share": "1",
    "plastic_area": "m^2",
    "plastic_share": "1",
    "max_pressure": "Pa",
    "mean_pressure": "Pa",
    "mean_gap": "m",
    "approach": "m",
    "normal_force": "N",
    "friction_force": "N",
    "friction_force_corrected": "N",
    "binormal_force": "N",
}
"""Numbers of a solution with their units."""


class Field(NamedTuple):
    """One field of the grid's shape, its unit, and one line on it."""

    values: NDArray[Any]
    unit: str
    description: str


def fields_of(solution: Reported) -> dict[str, Field]:
    """Return the fields that array files hold, by name; all of the grid's shape, indexed along x, then y."""
    periodic = solution.grid.periodic
    labels = patch_labels(solution.contact, periodic=periodic)
    return {
        "pressure": Field(solution.pressure, "Pa", "local contact pressure f"),
        "traction": Field(solution.traction, "Pa", "local friction r"),
        "gap": Field(solution.gap, "m", "gap between the deformed surfaces, by Eq. (6)"),
        "surface_lower": Field(solution.surface_lower, "m", "deformed height of the lower surface"),
        "surface_upper": Field(solution.surface_upper, "m", "deformed height of the upper surface"),
        "theta_x": Field(solution.theta_x, "rad", "slope angle along the sliding direction, positive uphill"),
        "theta_y": Field(solution.theta_y, "rad", "slope angle 90 degrees anticlockwise of sliding"),
        "plastic_indentation": Field(solution.plastic_indentation, "m", "plastic indentation w_p"),
        "plastic": Field(solution.plastic, "1", "elements at the hardness"),
        "excluded": Field(solution.excluded, "1", "elements without adhesive shear"),
        "patch": Field(labels, "1", "contact patch, numbered from 1; 0 without contact"),
    }


def numbers_of(solution: Reported) -> dict[str, float]:
    """Return the numbers of `UNITS`."""
    return {name: float(getattr(solution, name)) for name in UNITS}


def attributes_of(solution: Reported, provenance: Mapping[str, str] | None = None) -> dict[str, Any]:
    """Return status, numbers with their errors, settings and provenance as plain attributes of a file."""
    found: dict[str, Any] = {
        "title": "rough contact with friction, after Karpenko and Akay (2001)",
        "status": solution.status.value,
        "method": solution.plan.method,
        "tolerance": solution.tolerance,
        "largest_residual": float(solution.certificate.largest),
        "periodic": int(solution.grid.periodic),
        "sliding_direction": solution.sliding_direction,
        "warnings": "\n".join(map(str, solution.warnings)),
    }
    for name, value in numbers_of(solution).items():
        found[name] = value
        found[f"{name}_unit"] = UNITS[name]
        if name in solution.uncertainty:
            found[f"{name}_error"] = solution.error(name)
    return found | dict(provenance or {})


def as_dataset(solution: Reported, provenance: Mapping[str, str] | None = None) -> Any:
    """Return an `xarray.Dataset`: the fields over x and y (m, element centres), units as attributes.

    Raises `InputError` where xarray is not installed.
    """
    try:
        import xarray
    except ModuleNotFoundError as missing:
        allowed = "xarray installed: pip install '.[arrays]' in a checkout"
        raise InputError("to_xarray", "xarray", allowed) from missing
    centres = {"x": solution.grid.x, "y": solution.grid.y}
    data = {
        name: (("x", "y"), _numeric(field.values), {"units": field.unit, "long_name": field.description})
        for name, field in fields_of(solution).items()
    }
    coordinates = {axis: (axis, values, {"units": "m"}) for axis, values in centres.items()}
    return xarray.Dataset(data, coordinates, attributes_of(solution, provenance))


def _numeric(values: NDArray[Any]) -> NDArray[Any]:
    """Masks as bytes, which NetCDF has; other arrays as they are."""
    return values.astype(np.int8) if values.dtype == bool else values
