"""Both deformed surfaces with their contact fields, for ParaView."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from refimpl import Solution


def write(solution: Solution, path: Path) -> None:
    """Write the lower surface and, as a second sheet, the upper one.

    Points are the element centres at the deformed heights (m), cells lie between them. Point fields:
    `pressure` and `traction` (Pa), `gap` (m) between the deformed surfaces, `height` (m) to warp by, since
    heights of um on lengths of mm look flat, `body` (0 lower, 1 upper).
    """
    import meshio
    import numpy as np

    from verification.framework.files import replacing

    x, y = np.meshgrid(solution.grid.x, solution.grid.y, indexing="ij")
    sheets = [np.column_stack([x.ravel(), y.ravel(), z.ravel()])
              for z in (solution.surface_lower, solution.surface_upper)]  # fmt: skip
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
