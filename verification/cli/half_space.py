"""`rough-friction appendix-a surface`: how far a half-space may be trusted on a scene's surfaces."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from verification.cli.output import columns, emit

if TYPE_CHECKING:
    from refimpl import Solution
    from refimpl.grid import Array
    from refimpl.sensitivities.half_space import HalfSpaceError

ROWS = (  # name, label, factor, unit
    ("friction_coefficient", "mu", 1.0, ""),
    ("contact_area", "A", 1e6, "mm^2"),
    ("max_pressure", "p_max", 1e-6, "MPa"),
    ("approach", "approach", 1e6, "um"),
    ("normal_force", "N at this approach", 1.0, "N"),
)
COARSE = 0.02  # the paper's "less than 2 %"


def surface(options: argparse.Namespace) -> int:
    """Solve the scene, state the half-space's error in each number, and advise."""
    import numpy as np

    import refimpl
    from refimpl.sensitivities.half_space import advice, half_space_error, local_error
    from verification.cli.plot_style import check_suffix

    check_suffix(options.plot)
    scene = refimpl.read_scene(options.scene)
    solution = refimpl.solve(scene, options.grid)
    error = half_space_error(scene, solution)
    local = local_error(solution.problem)
    steep = float(np.mean(local > COARSE))
    told = advice(error, solution)
    numbers = {name: _row(name, solution, error) for name, *_ in ROWS}
    document = {
        "scene": options.scene,
        "grid": list(solution.grid.shape),
        "share_above_2_percent": steep,
        "largest_local_error": float(local.max()) if np.isfinite(local).all() else None,
        "numbers": numbers,
        "advice": told,
    }
    if options.plot is not None:
        _draw(local, solution, options.plot)
    rows = [["number", "half-space", "corrected", "stated error", ""]]
    for name, label, factor, unit in ROWS:
        row = numbers[name]
        rows.append(
            [
                label,
                f"{row['value'] * factor:.4g}",
                f"{row['corrected'] * factor:.4g}",
                f"{row['stated'] * factor:.2g}",
                unit,
            ]
        )
    text = (
        f"{options.scene}: {solution.grid} elements\n"
        f"coefficients of a flat are off by more than 2 % on {steep:.1%} of the area\n\n"
        f"{columns(rows)}\n\nstated error: first order, what it leaves, and finite strain\n{told}"
    )
    emit(document, options.json, text)
    return 0 if solution.converged else 1


def _row(name: str, solution: Solution, error: HalfSpaceError) -> dict[str, float]:
    value = float(getattr(solution, name))
    return {
        "value": value,
        "corrected": value + error.first_order[name],
        "stated": error.stated(name),
        "second_order": error.second_order[name],
        "finite_strain": error.finite_strain[name],
    }


def _draw(local: Array, solution: Solution, path: Path) -> None:
    """Write the map of the local coefficient error, the contact outlined."""
    from verification.cli.plot_style import ORANGE, print_style, write

    with print_style():
        import matplotlib.pyplot as plt

        figure, axes = plt.subplots(figsize=(4.4, 3.6), layout="constrained")
        x, y = solution.grid.x * 1e3, solution.grid.y * 1e3
        shown = axes.pcolormesh(x, y, 100 * local.T, cmap="cividis", shading="nearest", rasterized=True)
        figure.colorbar(shown, label="error of a flat's coefficients (%)")
        if solution.contact.any() and min(solution.grid.shape) > 1:
            axes.contour(x, y, solution.contact.T.astype(float), levels=[0.5], colors=ORANGE, linewidths=0.8)
        axes.set(xlabel="x (mm)", ylabel="y (mm)", aspect="equal")
        axes.set_title("at the undeformed slopes; contact outlined")
        write(figure, path)
