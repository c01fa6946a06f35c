"""A solution as files: arrays as NPZ or NetCDF, deformed surfaces for ParaView, contact patches as CSV."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from verification.output.text_table import csv_text

if TYPE_CHECKING:
    from refimpl import Solution

PATCH_UNITS = {"area": "m^2", "load": "N", "mean_pressure": "Pa", "max_pressure": "Pa", "x": "m", "y": "m"}
"""Units of the columns of a table of patches; the others have none."""


def require_netcdf(netcdf: Path | None) -> None:
    """Refuse, before any work, NetCDF without its library. Raises InputError."""
    from refimpl.errors import require_installed

    if netcdf is not None:
        allowed = "xarray and h5netcdf installed (in a checkout: pip install '.[arrays]'), or --npz"
        require_installed("--netcdf", str(netcdf), allowed, "xarray", "h5netcdf")


def write_npz(solution: Solution, path: Path) -> None:
    """Write the fields, ``x`` and ``y`` (m), and ``attributes``: units, numbers and provenance as JSON.

    A bar without an end is null there.
    """
    import numpy as np

    from refimpl.solution.arrays import attributes_of, fields_of
    from verification.cli.output import plain
    from verification.output.files import replacing, to_json

    fields = fields_of(solution)
    units = {name: field.unit for name, field in fields.items()}
    attributes = plain({**attributes_of(solution, _provenance()), "units": units})
    arrays: dict[str, Any] = {name: field.values for name, field in fields.items()}
    with replacing(path) as temporary, temporary.open("wb") as file:
        np.savez_compressed(
            file, x=solution.grid.x, y=solution.grid.y, attributes=np.array(to_json(attributes)), **arrays
        )


def write_netcdf(solution: Solution, path: Path) -> None:
    """Write the `xarray.Dataset` of `Solution.to_xarray` with the provenance among its attributes."""
    from tempfile import TemporaryDirectory

    from refimpl.solution.arrays import as_dataset
    from verification.output.files import replacing

    # a folder of its own: HDF5 locks the file that it writes, and `replacing` holds a lock on its own
    with TemporaryDirectory() as folder:
        whole = Path(folder) / "solution.nc"
        as_dataset(solution, _provenance()).to_netcdf(whole, engine="h5netcdf")
        with replacing(path) as temporary:
            temporary.write_bytes(whole.read_bytes())


def write_patches(solution: Solution, path: Path) -> None:
    """Write a row for each contact patch, units in the headers."""
    from dataclasses import astuple, fields

    from refimpl.solution.arrays import Patch
    from verification.output.files import write_text

    names = [field.name for field in fields(Patch)]
    head = [f"{name} [{PATCH_UNITS[name]}]" if name in PATCH_UNITS else name for name in names]
    write_text(csv_text([head, *map(astuple, solution.patches())]), path)


def write_vtk(solution: Solution, path: Path) -> None:
    """Write the lower deformed surface and, as a second sheet, the upper one, for ParaView.

    Points are the element centres at the deformed heights (m), cells lie between them. Point fields:
    `pressure` and `traction` (Pa), `gap` (m) between the deformed surfaces, `height` (m) to warp by, since
    heights of um on lengths of mm look flat, `body` (0 lower, 1 upper).
    """
    import meshio
    import numpy as np

    from verification.output.files import replacing

    x, y = np.meshgrid(solution.grid.x, solution.grid.y, indexing="ij")
    sheets = [np.column_stack([x.ravel(), y.ravel(), z.ravel()])
              for z in solution.surfaces]  # fmt: skip
    number = np.arange(x.size).reshape(x.shape)
    around = (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:])
    squares = np.stack(around, axis=-1).reshape(-1, 4)
    contact = {"pressure": solution.pressure, "traction": solution.traction, "gap": solution.gap}
    fields = {name: np.tile(values.ravel(), 2) for name, values in contact.items()}
    fields["height"] = np.concatenate([sheet[:, 2] for sheet in sheets])
    fields["body"] = np.repeat([0.0, 1.0], x.size)
    mesh = meshio.Mesh(
        np.vstack(sheets), [("quad", np.vstack([squares, squares + x.size]))], point_data=fields
    )
    with replacing(path) as temporary:
        mesh.write(temporary)


WRITERS = {"vtk": write_vtk, "npz": write_npz, "netcdf": write_netcdf, "patches": write_patches}
"""By the option that names the file."""


def _provenance() -> dict[str, str]:
    from verification.output.provenance import provenance

    return {f"provenance_{name}": str(value) for name, value in provenance().items()}
