"""`rough-friction appendix-a look-up` and `element`: the shipped tables of coefficient errors, read."""

from __future__ import annotations

import argparse
import math
from functools import cache
from importlib.resources import as_file, files
from typing import TYPE_CHECKING

from verification.cli.options import Options, number, option
from verification.cli.output import emit, refusal
from verification.output.text_table import columns

if TYPE_CHECKING:
    from appendix_a.fem.coefficient_map import CoefficientMap

SHARE = 0.1  # second order over first; more has a caution
LOOK_UP_OPTIONS: Options = {
    "--slope-deg": option("maximum slope of the profile (degrees)", type=number, required=True),
    "--wavelength": option("in half-widths of the strip", type=number, required=True),
    "--position": option("centre of the strip: crest 0, flank 0.25, valley 0.5", type=number, required=True),
    "--nu": option("Poisson's ratio", type=number, required=True),
}
ELEMENT_OPTIONS: Options = {name: LOOK_UP_OPTIONS[name] for name in ("--slope-deg", "--nu")}
PAIR: tuple[str, str, Options] = (
    "a pair",
    "the first orders enter as lower minus upper",
    {
        "--E": option("modulus of the lower body (any unit)", type=number, default=1.0),
        "--upper-E": option("modulus of the upper body, the same unit", type=number),
        "--upper-nu": option("its Poisson's ratio", type=number),
    },
)


@cache
def shipped_map() -> CoefficientMap:
    """Return the plane map that comes with the solver."""
    from appendix_a.fem.coefficient_map import CoefficientMap

    with as_file(files("refimpl") / "data" / "coefficient_error.json") as path:
        return CoefficientMap.read(path)


def look_up(options: argparse.Namespace) -> int:
    """Print the percentage by which the coefficients at the map's offsets are off."""
    from appendix_a.fem.coefficient_map import interpolation_error

    upper = _upper(options)
    table = shipped_map()
    where = options.slope_deg, options.wavelength, options.position
    if upper is None:
        percent = table.percent(*where, options.nu)
    else:
        percent = table.pair_percent(*where, (options.E, options.nu), upper)
    own = float(table.error_percentage_points.max())
    near, far = (own + error for error in interpolation_error(options.slope_deg))
    rows = [["offset", "wavy over flat (%)"]]
    rows += [[f"{x:g}", f"{value:+.3f}"] for x, value in zip(table.offset, percent, strict=True)]
    document = {
        "offsets": list(table.offset), "percent": percent.tolist(),
        "stated_error_percentage_points": {"next elements": near, "offsets up to 10": far},
    }  # fmt: skip
    text = (
        f"{columns(rows, indent='')}\n\nstated error, interpolation in it: {near:.2g} percentage points "
        f"at offsets -2 and 2, {far:.2g} up to 10"
    )
    emit(document, options.json, text)
    return 0


def element(options: argparse.Namespace) -> int:
    """Print the largest errors of a square element's coefficients (percent) on crest, flank and valley."""
    from refimpl import Material
    from refimpl.half_space.influence_error_3d import element_error

    upper = _upper(options)
    bodies = [Material(options.E, options.nu), *([] if upper is None else [Material(*upper)])]
    found = element_error(math.radians(options.slope_deg), *bodies)
    percent = {
        "self": 100 * found.self_coefficient, "in line": 100 * found.in_line, "across": 100 * found.across,
    }  # fmt: skip
    rows = [["coefficient", "largest error (%)"], *([name, f"{p:.2f}"] for name, p in percent.items())]
    remark = "waves of ten elements, crest, flank and valley; ridges of 25 and 50 elements: at most 6 % more"
    emit({"percent": percent}, options.json, f"{columns(rows, indent='')}\n\n{remark}")
    return 0


def _upper(options: argparse.Namespace) -> tuple[float, float] | None:
    from refimpl.errors import require_size

    given = options.upper_E, options.upper_nu
    if given == (None, None):
        return None
    if None in given:
        name = "upper-E" if given[0] is None else "upper-nu"
        raise refusal(f"--{name}", None, "both --upper-E and --upper-nu, or neither")
    for name, modulus in (("--E", options.E), ("--upper-E", options.upper_E)):
        require_size(name, modulus, "a positive modulus")
    return options.upper_E, options.upper_nu


def first_order_note(slope_deg: float, wavelength: float, position: float, nu: float) -> str:
    """Return what the first order misses of the next elements' coefficients; empty where that is little.

    By the shipped map: its part beyond the first order, in percentage points of the flat coefficient.
    """
    import numpy as np

    from appendix_a.strip import first_order

    table = shipped_map()
    if slope_deg > table.slope_deg[-1] or wavelength < table.wavelength[0]:
        return (
            f"caution: beyond {table.slope_deg[-1]:g} degrees, or below {table.wavelength[0]:g} half-widths, "
            "what the first order misses is not known; see appendix-a fem"
        )
    next_ones = [table.offset.index(-2.0), table.offset.index(2.0)]
    whole = table.percent(slope_deg, wavelength, position, nu)[next_ones]
    wavy, flat = first_order(slope_deg, wavelength, position, nu, offsets=[-2.0, 2.0])
    first = 100 * (wavy - flat) / flat
    missed = float(np.abs(whole - first).max())
    if missed <= SHARE * float(np.abs(first).max()):
        return ""
    return (
        f"caution: the first order, {np.abs(first).max():.2g} %, misses {missed:.2g} percentage points of "
        "the next elements' coefficients by the shipped map; see appendix-a fem"
    )
