"""The keys of scene files with units and meanings, by table; types, defaults and limits stand in the classes.

What reads, writes and explains scene files takes the keys from here. `refimpl.scene.keys.scene_keys` refuses
a key that its class does not have, or one that is missing.
"""

from __future__ import annotations

Texts = dict[str, tuple[str, str]]
"""Unit and meaning by key."""

SCENE: Texts = {
    "load": ("N", "normal load P"),
    "side": ("m", "edge of a square domain"),
    "size": (
        "m",
        "lengths `[Lx, Ly]` of a rectangular domain, in place of `side`; with measured surfaces neither is "
        "needed: the domain is then the largest rectangle that all of them cover",
    ),
    "sliding_direction": (
        "rad",
        "angle phi from x, anticlockwise; the upper body slides along `(cos phi, sin phi)`",
    ),
    "sliding_offset": ("m", "distance slid so far; the lower surface is sampled at x + offset"),
    "periodic": ("", "the doubly periodic problem, in place of half-spaces that are free outside the domain"),
    "plastic": (
        "",
        "pressure cap at the hardness: `true` requests the cap, `false` is elastic at any pressure; not set: "
        "the cap enters where pressures reach a given hardness",
    ),
    "upper": ("", "upper body, which slides: `[upper.material]`, `[[upper.surface]]`"),
    "lower": ("", "lower body, at rest: `[lower.material]`, `[[lower.surface]]`"),
    "friction": ("", "local friction law, Eq. (1); without the table there is no friction"),
    "tolerances": (
        "",
        "relative half-widths (95 %) of parameters, for the budget of `solve`; names below",
    ),
}

BODY: Texts = {
    "material": ("", "elastic half-space"),
    "surface": (
        "",
        "parts whose heights add up, a `[[...surface]]` table each; without one the body is flat",
    ),
}

MATERIAL: Texts = {
    "E": ("Pa", 'Young\'s modulus; `"rigid"` for a rigid body, at most one of the two'),
    "nu": ("", "Poisson's ratio"),
    "hardness": ("Pa", "contact pressures are capped there (`plastic`); the smaller of two counts"),
}

FRICTION: Texts = {
    "tau": ("Pa", "adhesive shear strength: shear traction `r = tau + beta f` in contact"),
    "beta": ("", "coefficient of the contact pressure f"),
}

_SEED = "seed of the noise: one continuous surface per seed, the same on every grid and at every offset"
_LAY = "angle from x to the direction along the lay"

SURFACES: dict[str, Texts] = {
    "flat": {},
    "sphere": {"radius": ("m", "of the paraboloid `(x^2 + y^2) / (2 radius)` about the domain's middle")},
    "gaussian": {
        "rms": ("m", "rms height of the ensemble"),
        "correlation_length": (
            "m",
            "length at which the autocorrelation falls to `acf_level`; two: along the lay, across it",
        ),
        "seed": ("", _SEED),
        "normalise": ("", "scale this realisation to `rms` over the domain, as the paper does"),
        "lay": ("rad", _LAY),
        "acf_level": ("", "0.1 in the paper; ISO 25178's Sal has 0.2, 1/e lengths have 0.3679"),
    },
    "self_affine": {
        "hurst": ("", "Hurst exponent H of the PSD `q^(-2-2H)`"),
        "roll_off": ("m", "wavelength above which the PSD is constant"),
        "long_cut": ("m", "longest wavelength, at least `roll_off`"),
        "short_cut": ("m", "shortest wavelength, less than `roll_off`"),
        "seed": ("", _SEED),
        "rms": ("m", "rms height of the ensemble; either this or `rms_gradient`"),
        "rms_gradient": ("", "rms of the gradient's length (Sdq)"),
        "anisotropy": ("", "factor by which the surface is stretched along the lay"),
        "lay": ("rad", _LAY),
    },
    "measured": {
        "path": ("", "the file, relative to the scene's file"),
        "unit": ("", "unit of the heights; overrides the file's, with a note"),
        "pixel_size": (
            "m",
            "edges of a pixel, one number or `[dx, dy]`; overrides the file's, with a note; of points x, y, "
            "z it only states that x and y have another unit than z",
        ),
        "channel": ("", "name or number of the channel; not set: the first one of heights"),
        "outliers": (
            "",
            "points further from their neighbours than this many spreads become missing; 6 to 10 is usual. "
            "The distance is the median, over the four lines through a point, of that from the mean of its "
            "two neighbours; a spread is the rms of such distances, from their median over the map, or from "
            "their 80th percentile over the 5 x 5 points around where that is larger",
        ),
        "scan_lines": (
            "",
            'axis of the file along which it was scanned, `"x"` or `"y"`: each line loses its slope and its '
            "median (SurfaceTopography's scan_line_align), and so what the surface has across the lines",
        ),
        "low_pass": ("m", "shorter waves are damped (S-filter), by half at this wavelength"),
        "high_pass": ("m", "longer waves are damped (L-filter), by half at this wavelength"),
        "level": (
            "",
            "form to be subtracted, fitted along z to the measured points of the domain at offset 0; not "
            'set: `"plane"`, or `"mean"` of a map that repeats',
        ),
        "missing": ("", "fill missing points by Laplace's equation, or refuse them"),
        "max_missing": ("", "largest fraction of the domain's points that may be missing"),
        "replica": ("", "negate the heights: a cast of the surface was measured"),
        "mirror": ("", '`"x"`: x -> -x; `"y"`: y -> -y'),
        "rotate_deg": ("degrees", "rotation, anticlockwise seen from outside the body"),
        "turn_over": (
            "",
            "turn the specimen over about the x axis, `z(x, y) -> -z(x, -y)`; not set: on the upper body",
        ),
        "centre": (
            "m",
            "point of the file's own area, from its lower left corner, at the domain's middle; not set: the "
            "area's middle",
        ),
        "repeats": ("", "the map repeats with its own area (for periodic scenes)"),
        "height_scale": (
            "",
            "factor on all heights; its relative half-width in `[tolerances]` is the uncertainty of the "
            "instrument's z calibration",
        ),
    },
}
