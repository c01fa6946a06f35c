"""A solution's fields with names, units and coordinates, for array files and for xarray."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from refimpl.errors import require_installed
from refimpl.grid import Array, Grid, Mask
from refimpl.grid.contact_patches import patch_centres, patch_labels
from refimpl.solution.quantities import QUANTITIES
from refimpl.solution.record import Record


@dataclass(frozen=True)
class Patch:
    """One contact patch: elements in contact that touch one another, at corners too.

    label : number in the order of the array, from 1
    elements : number of elements
    area : real contact area (m^2)
    load : ``sum f dA`` (N), the pressure's part of the normal force
    mean_pressure, max_pressure : of its elements (Pa)
    x, y : centre, weighted by pressure, inside the domain (m)
    plastic_share : share of its area at the hardness
    """

    label: int
    elements: int
    area: float
    load: float
    mean_pressure: float
    max_pressure: float
    x: float
    y: float
    plastic_share: float


def patches_of(pressure: Array, plastic: Mask, grid: Grid) -> tuple[Patch, ...]:
    """Return the patches of a pressure (Pa), across a periodic border too; ``plastic`` marks H."""
    labels = patch_labels(pressure > 0, periodic=grid.periodic).ravel()
    f = pressure.ravel()
    count = np.bincount(labels)[1:]
    total = np.bincount(labels, f)[1:]
    largest = np.zeros(len(count) + 1)
    np.maximum.at(largest, labels, f)
    at_hardness = np.bincount(labels, plastic.ravel())[1:]
    X, Y = np.meshgrid(grid.x, grid.y, indexing="ij")
    centres = [
        patch_centres(labels, f, along.ravel(), length, grid.periodic)
        for along, length in zip((X, Y), grid.lengths, strict=True)
    ]
    dA = grid.element_area
    return tuple(
        Patch(
            label=k + 1,
            elements=int(count[k]),
            area=float(count[k]) * dA,
            load=float(total[k]) * dA,
            mean_pressure=float(total[k] / count[k]),
            max_pressure=float(largest[k + 1]),
            x=float(centres[0][k]),
            y=float(centres[1][k]),
            plastic_share=float(at_hardness[k] / count[k]),
        )
        for k in range(len(count))
    )


class Field(NamedTuple):
    """One field of the grid's shape, its unit, and one line on it."""

    values: NDArray[Any]
    unit: str
    description: str


def fields_of(solution: Record) -> dict[str, Field]:
    """Return the fields that array files hold, by name; all of the grid's shape, indexed along x, then y."""
    periodic = solution.grid.periodic
    lower, upper = solution.surfaces
    labels = patch_labels(solution.contact, periodic=periodic)
    return {
        "pressure": Field(solution.pressure, "Pa", "local contact pressure f"),
        "traction": Field(solution.traction, "Pa", "local friction r"),
        "gap": Field(solution.gap, "m", "gap between the deformed surfaces, by Eq. (6)"),
        "surface_lower": Field(lower, "m", "deformed height of the lower surface"),
        "surface_upper": Field(upper, "m", "deformed height of the upper surface"),
        "theta_x": Field(
            solution.slopes.theta_x, "rad", "slope angle along the sliding direction, positive uphill"
        ),
        "theta_y": Field(solution.slopes.theta_y, "rad", "slope angle 90 degrees anticlockwise of sliding"),
        "plastic_indentation": Field(solution.plastic_indentation, "m", "plastic indentation w_p"),
        "plastic": Field(solution.details.plastic, "1", "elements at the hardness"),
        "excluded": Field(solution.details.excluded, "1", "elements without adhesive shear"),
        "patch": Field(labels, "1", "contact patch, numbered from 1; 0 without contact"),
    }


def attributes_of(solution: Record, provenance: Mapping[str, str] | None = None) -> dict[str, Any]:
    """Return status, numbers with their errors, settings and provenance as plain attributes of a file."""
    found: dict[str, Any] = {
        "title": "rough contact with friction, after Karpenko and Akay (2001)",
        "status": solution.status.value,
        "method": solution.plan.method,
        "tolerance": solution.details.tolerance,
        "largest_residual": float(solution.certificate.largest),
        "periodic": int(solution.grid.periodic),
        "sliding_direction": solution.details.sliding_direction,
        "warnings": "\n".join(map(str, solution.warnings)),
    }
    for name, quantity in QUANTITIES.items():
        found |= {name: float(getattr(solution, name)), f"{name}_unit": quantity.unit}
        if (error := solution.error(name)) is not None:
            found[f"{name}_error"] = error
    return found | dict(provenance or {})


def as_dataset(solution: Record, provenance: Mapping[str, str] | None = None) -> Any:
    """Return an `xarray.Dataset` of the fields over x and y (m); `InputError` without xarray."""
    allowed = "xarray installed: pip install '.[arrays]' in a checkout"
    require_installed("to_xarray", "xarray", allowed, "xarray")
    import xarray

    centres = {"x": solution.grid.x, "y": solution.grid.y}
    data = {
        name: (("x", "y"), _numeric(field.values), {"units": field.unit, "long_name": field.description})
        for name, field in fields_of(solution).items()
    }
    coordinates = {axis: (axis, values, {"units": "m"}) for axis, values in centres.items()}
    return xarray.Dataset(data, coordinates, attributes_of(solution, provenance))


def _numeric(values: NDArray[Any]) -> NDArray[Any]:
    """Return the masks as bytes, which NetCDF has; other arrays as they are."""
    return values.astype(np.int8) if values.dtype == bool else values
