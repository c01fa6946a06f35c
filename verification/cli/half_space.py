"""`rough-friction appendix-a surface`: how far a half-space may be trusted on one's own surface."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from verification.cli.options import DEFAULT_GRID, Options, option, picture
from verification.cli.output import check_outputs, emit, files_of, refusal
from verification.output.text_table import columns, wrapped

if TYPE_CHECKING:
    from refimpl import Scene
    from refimpl.sensitivities.surface_verdict import SurfaceVerdict

ALONE = {"E": 200e9, "nu": 0.3, "tau": 0.0, "beta": 0.1}  # assumed for a surface file

OPTIONS: Options = {
    "scene": option("a scene (.toml, or a shipped one's name), or a surface's file", metavar="SCENE|FILE"),
    "--grid": option(f"elements along the longer side ({DEFAULT_GRID})", type=int),
    "--plot": option("map of the local coefficient error, .png or .svg", metavar="FILE", type=picture),
}
SURFACE_FILE: tuple[str, str, Options] = (
    "a surface's file",
    "the surface is pressed by a rigid flat, so the error is that of one body without cancellation",
    {
        "--E": option("Young's modulus (Pa, default 200e9)", type=float),
        "--nu": option("Poisson's ratio (default 0.3)", type=float),
        "--tau": option("local friction's shear strength (Pa, default 0)", type=float),
        "--beta": option("local friction's pressure coefficient (default 0.1)", type=float),
        "--pressure": option("nominal pressure (Pa, default E* Sdq / 20)", type=float),
        "--unit": option("of the heights: m, mm, um, nm, A or pm"),
        "--pixel-size": option("edge of a pixel (m)", metavar="D", type=float),
    },
)
FILE_OPTIONS = tuple(name.removeprefix("--").replace("-", "_") for name in SURFACE_FILE[2])


def surface(options: argparse.Namespace) -> int:
    """Solve, state the half-space's error in each number and on each element, and advise."""
    from refimpl.sensitivities.surface_verdict import surface_verdict

    scene, note = _posed(options)
    check_outputs([Path(options.scene), *files_of(scene)], plot=options.plot, json=options.json)
    verdict = surface_verdict(scene, options.grid)
    if options.plot is not None:
        from verification.cli.plot_surface import draw_local_error

        draw_local_error(verdict, options.plot)
    emit(_document(options.scene, note, verdict), options.json, _text(options.scene, note, verdict))
    return 0


def _posed(options: argparse.Namespace) -> tuple[Scene, str]:
    """Return the scene, and what was assumed where a surface's file is all there is."""
    import refimpl
    from refimpl.sensitivities.surface_verdict import pressed_on_a_flat

    given = {name: value for name in FILE_OPTIONS if (value := getattr(options, name)) is not None}
    path = Path(options.scene)
    if path.suffix == ".toml" or options.scene in refimpl.shipped_scenes():
        if given:
            name, value = next(iter(given.items()))
            allowed = "none beside a scene, which states it"
            raise refusal(f"--{name.replace('_', '-')}", value, allowed)
        return refimpl.read_scene(options.scene), ""
    if not path.is_file():
        known = ", ".join(refimpl.shipped_scenes())
        raise refusal("scene", options.scene, f"a scene's file (.toml), one of {known}, or a surface's file")
    reading = {name: given[name] for name in ("unit", "pixel_size") if name in given}
    taken = ALONE | {name: given[name] for name in ALONE if name in given}
    measured = refimpl.MeasuredSurface(options.scene, **reading)
    scene = pressed_on_a_flat(
        measured,
        refimpl.Material(taken["E"], taken["nu"]),
        grid=options.grid,
        pressure=given.get("pressure"),
        friction=refimpl.Friction(taken["tau"], taken["beta"]),
    )
    nominal = scene.load / (scene.lengths[0] * scene.lengths[1])
    return scene, (
        f"one body below a rigid flat: E = {taken['E'] / 1e9:g} GPa, nu = {taken['nu']:g}, "
        f"tau = {taken['tau'] / 1e6:g} MPa, beta = {taken['beta']:g}, "
        f"nominal pressure {nominal / 1e6:.4g} MPa; a pair of elastic bodies, whose first orders "
        "subtract, needs a scene"
    )


def _document(name: str, note: str, verdict: SurfaceVerdict) -> Mapping[str, object]:
    import numpy as np

    return {
        "scene": name,
        "assumed": note,
        "grid": list(verdict.solution.grid.shape),
        "share_above_2_percent": verdict.share_above,
        "largest_local_error": float(verdict.local.max()),
        "median_local_error": float(np.median(verdict.local)),
        "short_wave_share": verdict.short_waves,
        "numbers": verdict.numbers(),
        "advice": verdict.advice,
        "evidence": verdict.evidence,
    }


def _text(name: str, note: str, verdict: SurfaceVerdict) -> str:
    from refimpl.solution.quantities import QUANTITIES
    from refimpl.solution.units import printed_unit

    rows = [["number", "half-space", "corrected", "stated error", ""]]
    for number, row in verdict.numbers().items():
        unit = printed_unit(row["value"], QUANTITIES[number].unit)
        value, corrected, stated = (row[key] / unit.size for key in ("value", "corrected", "stated"))
        rows.append(
            [QUANTITIES[number].label, f"{value:.4g}", f"{corrected:.4g}", f"{stated:.2g}", unit.name]
        )
    lines = [f"{name}: {verdict.solution.grid} elements"]
    if note:
        lines.append(wrapped(note, "assumed: "))
    lines.append(f"coefficients of a flat are off by more than 2 % on {verdict.share_above:.1%} of the area")
    lines += [
        "",
        columns(rows),
        "",
        "stated error: first order, what it leaves, and finite strain; N: at this approach",
    ]
    lines += [wrapped(verdict.advice, ""), wrapped(verdict.evidence, "evidence: ")]
    return "\n".join(lines)
