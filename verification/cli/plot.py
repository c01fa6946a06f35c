"""A solution as a picture: maps of pressure and traction, and profiles through the centre."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from refimpl import Scene, Solution
    from verification.exact.hertz import Sphere as HertzSphere

BLUE, ORANGE, BLACK = (
    "#0072B2",
    "#D55E00",
    "#000000",
)  # Okabe and Ito 2008, safe for colour-blind readers
MEGA, MILLI = 1e6, 1e-3
SLENDER = 4.0
FORMATS = (".png", ".svg", ".pdf")


def check_suffix(path: Path | None) -> None:
    """Refuse, before any work, a picture of another format. Raises InputError."""
    from refimpl.errors import InputError

    if path is not None and path.suffix not in FORMATS:
        raise InputError("--plot", str(path), f"a file name that ends in {', '.join(FORMATS)}")


def draw(solution: Solution, scene: Scene, path: Path) -> None:
    """Write the picture: two maps above, profiles along x and y below, against Hertz for a sphere."""
    import matplotlib

    matplotlib.use("Agg")  # no display is needed
    import matplotlib.pyplot as plt

    from verification.framework.files import replacing

    figure, axes = plt.subplots(2, 2, figsize=(9.5, 8), layout="constrained")
    _map(axes[0, 0], solution, "pressure", "viridis")
    _map(axes[0, 1], solution, "traction", "cividis")
    hertz = hertz_of(scene, solution.normal_force)
    _profile(axes[1, 0], solution, hertz, axis=0)
    _profile(axes[1, 1], solution, hertz, axis=1)
    figure.legend(*axes[1, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    figure.suptitle(
        f"$\\mu$ = {solution.friction_coefficient:.4f},  A = {solution.contact_area / MILLI**2:.4g} mm$^2$,  "
        f"$f_{{max}}$ = {solution.max_pressure / MEGA:.4g} MPa,  {solution.status.value};  "
        f"the upper body slides at {math.degrees(solution.sliding_direction):g}° from x"
    )
    with replacing(path) as temporary:
        figure.savefig(temporary, dpi=130)
    plt.close(figure)


def hertz_of(scene: Scene, load: float) -> HertzSphere | None:
    """The smooth, frictionless Hertz contact of a scene with a sphere; None for a scene without one."""
    from refimpl.surfaces.shapes import Sphere
    from verification.exact import hertz

    curvature = sum(
        sign / part.radius
        for sign, body in ((1, scene.upper), (-1, scene.lower))
        for part in getattr(body.surface, "parts", (body.surface,))
        if isinstance(part, Sphere)
    )
    if scene.periodic or curvature <= 0 or load <= 0:
        return None
    return hertz.Sphere(load=load, radius=1 / curvature, modulus=scene.materials.reduced_modulus)


def _map(axes: Axes, solution: Solution, name: str, colours: str) -> None:
    """One field in MPa over the domain in mm; places without contact are left white.

    Lengths of a slender domain are not drawn to one scale.
    """
    import numpy as np

    field = np.ma.masked_equal(getattr(solution, name) / MEGA, 0.0)
    width, height = (length / MILLI for length in solution.grid.lengths)
    aspect: Literal["equal", "auto"] = (
        "equal" if max(width, height) <= SLENDER * min(width, height) else "auto"
    )
    image = axes.imshow(field.T, origin="lower", extent=(0, width, 0, height), cmap=colours, aspect=aspect)
    axes.set(xlabel="x (mm)", ylabel="y (mm)", title=name.capitalize())
    axes.figure.colorbar(image, ax=axes, label="MPa")


def _profile(axes: Axes, solution: Solution, hertz: HertzSphere | None, axis: int) -> None:
    """Pressure and traction (MPa) along the line of elements next to the centre."""
    import numpy as np

    grid = solution.grid
    centred = [centres - length / 2 for centres, length in zip((grid.x, grid.y), grid.lengths, strict=True)]
    s, across = centred[axis], centred[1 - axis]
    middle = len(across) // 2
    for name, colour in (("pressure", BLUE), ("traction", ORANGE)):
        line = np.take(getattr(solution, name), middle, axis=1 - axis)
        axes.plot(s / MILLI, line / MEGA, color=colour, label=name, marker=".", markersize=3, linewidth=1)
    if hertz is not None:
        fine = np.linspace(s[0], s[-1], 2001)
        label = "Hertz, smooth and frictionless"
        axes.plot(
            fine / MILLI,
            hertz.pressure(np.hypot(fine, across[middle])) / MEGA,
            "--",
            color=BLACK,
            lw=1,
            label=label,
        )
    letter = "xy"[axis]
    title = f"Profile through the centre along {letter}"
    axes.set(xlabel=f"{letter} from the centre (mm)", ylabel="MPa", title=title)
    if axes.get_ylim()[1] < solution.max_pressure / MEGA / 100:
        axes.set_ylim(top=solution.max_pressure / MEGA)
        axes.text(0.5, 0.5, "no contact on this line", ha="center", transform=axes.transAxes)
    axes.set_ylim(bottom=0)
