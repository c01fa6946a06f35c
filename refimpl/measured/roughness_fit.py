"""Random roughness like a measured map: parameters of a Gaussian or self-affine surface, with uncertainties.

Uncertainties are standard deviations over maps drawn with the fitted parameters and the same points missing,
levelled by a plane and fitted in the same way (a parametric bootstrap; Efron & Tibshirani 1993, chapter 6).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy

from refimpl.errors import InputError
from refimpl.grid import Array
from refimpl.measured.areal_parameters import Autocorrelation, Pixel
from refimpl.measured.detrending import fit as fit_polynomial
from refimpl.measured.spectrum import Spectrum
from refimpl.surfaces.noise_lattice import DECAY
from refimpl.surfaces.waves import rotated

KINDS = ("gaussian", "self-affine")
_CARRIED = 0.97  # part of the mean square slope; up to 0.99 the edge at short_cut alone makes a misfit of 2
ALIEN = 1.0  # misfit from which a map is of another kind: 15 maps of their kind have at most 0.73, others 12
_LARGEST = 512  # points an axis of drawn maps
_SET = ("long_cut", "short_cut")
_SCALES = ("rms", "lx", "ly", "roll_off", "anisotropy")  # the bias of which is a factor
_UNITS = {
    "rms": "m",
    "correlation_length": "m",
    "roll_off": "m",
    "long_cut": "m",
    "short_cut": "m",
    "lay": "rad",
}

Values = dict[str, float]
Lay = tuple[float, float, float]


@dataclass(frozen=True)
class RoughnessFit:
    """Parameters of a random surface by the keys of a scene file, SI, and their standard deviations.

    Lengths of a Gaussian surface are ``lx``, ``ly`` here. What has no deviation is set, not fitted.
    ``misfit``: rms of ln(C of the map / mean C of the drawn maps) over the rings of the spectrum that carry
    97 % of the map's mean square slope, and the mean of that of each drawn map: a good fit has both alike.
    """

    kind: str
    values: Values
    deviations: Values
    notes: tuple[str, ...]
    misfit: tuple[float, float]

    def table(self, seed: int = 1) -> dict[str, object]:
        """Return the surface as a table of a scene file."""
        values = dict(self.values)
        table: dict[str, object] = {"kind": "self_affine" if self.kind == "self-affine" else self.kind}
        if self.kind == "gaussian":
            lx, ly = values.pop("lx"), values.pop("ly")
            table["rms"] = values.pop("rms")
            table["correlation_length"] = lx if lx == ly else [lx, ly]
        return {**table, **values, "seed": seed}

    def toml(self, seed: int = 1) -> str:
        """Format the table as TOML, uncertainties as comments."""
        own, drawn = self.misfit
        said = f"misfit {own:.2g}, drawn maps {drawn:.2g} (rms of ln(C of the map / C of the fit))"
        lines = [f"# {note}" for note in (said, *self.notes)]
        for key, value in self.table(seed).items():
            names = ("lx", "ly") if key == "correlation_length" else (key,)
            spreads = [self.deviations[name] for name in names if name in self.deviations]
            said = f"  # {_UNITS.get(key, '')}".rstrip(" #") if key not in ("kind", "seed") else ""
            if spreads:
                said = f"{said or '  #'} +- {', '.join(f'{s:.2g}' for s in dict.fromkeys(spreads))}"
            lines.append(f"{key} = {_toml(value)}{said}")
        return "\n".join(lines) + "\n"


def _toml(value: object) -> str:
    if isinstance(value, list):
        return f"[{', '.join(_toml(v) for v in value)}]"
    return f'"{value}"' if isinstance(value, str) else f"{value:.6g}"


def fit_roughness(z: Array, pixel: Pixel, kind: str, draws: int = 16) -> RoughnessFit:
    """Fit a kind of KINDS to a levelled map (m; missing points NaN); ``draws`` maps for the deviations."""
    if kind not in KINDS:
        raise InputError("fit", kind, " or ".join(KINDS))
    estimate = _gaussian if kind == "gaussian" else _self_affine
    if not np.nanvar(z) > 0:
        raise InputError("fit", "a flat map", "a rough one")
    values, notes = estimate(z, pixel)
    density = _gaussian_psd if kind == "gaussian" else _self_affine_psd
    drawn, misfit = _estimates(z, pixel, values, density(values), estimate, draws)
    means = {name: float(np.mean(found)) for name, found in drawn.items()}
    unbiased = {name: value**2 / means[name] if name in _SCALES else value for name, value in values.items()}
    if "hurst" in values:
        unbiased["hurst"] = float(np.clip(2 * values["hurst"] - means["hurst"], 0.01, 1.0))
    deviations = {name: float(np.std(found, ddof=1)) for name, found in drawn.items() if name not in _SET}
    if misfit[0] > ALIEN:
        said = f"warning: the map is not {kind}: spectra differ by factors of e^{misfit[0]:.2g}"
        notes = (f"{said}, do not use this fit", *notes)
    return RoughnessFit(kind, unbiased, deviations, notes, misfit)


def _gaussian(z: Array, pixel: Pixel) -> tuple[Values, tuple[str, ...]]:
    """Return the rms height; lengths of Eq. (9) and lay from the autocorrelation's ellipse."""
    lx, ly, lay = _ellipse(z, pixel)
    found = {"rms": float(np.nanstd(z)), "lx": lx, "ly": ly}
    return found | ({"lay": lay} if lx > ly else {}), ()


def _ellipse(z: Array, pixel: Pixel) -> Lay:
    """Return the longer and shorter length of Eq. (9), and the lay (rad)."""
    long, short, lay = Autocorrelation.of(z, pixel).lay()
    return long * math.sqrt(DECAY), short * math.sqrt(DECAY), lay


def _gaussian_psd(values: Values) -> Callable[[Array, Array], Array]:
    lx, ly, lay = values["lx"], values["ly"], values.get("lay", 0.0)

    def density(qx: Array, qy: Array) -> Array:
        along, across = rotated(qx, qy, lay)
        return np.asarray(np.exp(-((along * lx) ** 2 + (across * ly) ** 2) / (4.0 * DECAY)))

    return density


def _self_affine(z: Array, pixel: Pixel) -> tuple[Values, tuple[str, ...]]:
    """Return anisotropy and lay by the autocorrelation, hurst and roll-off by Whittle's likelihood."""
    long, short, lay = _ellipse(z, pixel)
    g = long / short
    spectrum = Spectrum.of(z, pixel, g, lay if g > 1.0 else 0.0)
    size = max(n * edge for n, edge in zip(z.shape, pixel, strict=True))
    notes: tuple[str, ...] = ()
    if (short_cut := spectrum.short_cut()) is None:
        short_cut = 2.0 * max(pixel)
        notes = ("short_cut is two pixels, the shortest wave that was measured: slopes depend on it",)
    use = spectrum.q < 2 * np.pi / max(1.2 * short_cut, 4.0 * max(pixel))
    use[:1] = False  # the plane is subtracted
    q, C, count = spectrum.q[use], spectrum.C[use], spectrum.count[use]
    if len(q) < 6:
        raise InputError("fit", f"a map of {len(q)} rings of its spectrum", "6 at least: a larger map")

    def loss(numbers: Array) -> float:
        hurst, log_roll = numbers
        shape = np.maximum(q * math.exp(-log_roll), 1.0) ** (-2.0 - 2.0 * hurst)
        level = float(np.sum(count * C / shape) / np.sum(count))
        misfit = float(np.sum(count * np.log(level * shape)) / np.sum(count))
        return misfit + 100.0 * max(-float(hurst), float(hurst) - 1.0, 0.0)

    starts = [
        (h, math.log(q0)) for h in (0.2, 0.5, 0.8) for q0 in q[: max(len(q) // 2, 1) : max(len(q) // 16, 1)]
    ]
    best = min(starts, key=lambda s: loss(np.array(s)))
    hurst, log_roll = scipy.optimize.minimize(
        loss, np.array(best), method="Nelder-Mead", options={"xatol": 1e-4, "fatol": 1e-9}
    ).x
    roll_off = 2 * math.pi * math.exp(-log_roll)
    if roll_off > size / 2.0:
        roll_off = size
        notes = (*notes, "no roll-off within the map: roll_off and long_cut are its longer side")
    else:
        notes = (*notes, "long_cut is the longer side of the map, which sees no longer waves")
    if roll_off < 10 * short_cut:
        notes = (*notes, "less than a decade between roll_off and short_cut: hurst is hardly determined")
    values = {"hurst": float(np.clip(hurst, 0.01, 1.0)), "rms": float(np.nanstd(z)), "roll_off": roll_off,
              "long_cut": size, "short_cut": short_cut}  # fmt: skip
    return values | ({"anisotropy": g, "lay": lay} if g > 1.0 else {}), notes


def _self_affine_psd(values: Values) -> Callable[[Array, Array], Array]:
    g, lay = values.get("anisotropy", 1.0), values.get("lay", 0.0)
    q_long, q_roll, q_short = (2 * math.pi / values[key] for key in ("long_cut", "roll_off", "short_cut"))

    def density(qx: Array, qy: Array) -> Array:
        along, across = rotated(qx, qy, lay)
        q = np.hypot(g * along, across)
        power = np.maximum(q / q_roll, 1.0) ** (-2.0 - 2.0 * values["hurst"])
        return np.where((q >= 0.999 * q_long) & (q <= q_short), power, 0.0)

    return density


def _estimates(
    z: Array,
    pixel: Pixel,
    values: Values,
    density: Callable[[Array, Array], Array],
    estimate: Callable[[Array, Pixel], tuple[Values, tuple[str, ...]]],
    draws: int,
) -> tuple[dict[str, Array], tuple[float, float]]:
    """Return the estimates from drawn maps, by name, and the misfit of ``z`` to their spectra.

    Maps of more than 512 points an axis are thinned; where that loses waves a part of the map is drawn.
    """
    shape = z.shape
    thin = max(1, math.ceil(max(shape) / _LARGEST))
    finest = values.get("ly", values.get("roll_off", 0.0)) / max(pixel)
    part = thin > 1 and finest < 12 * thin
    drawn_shape = tuple(min(n, _LARGEST) if part else max(n // thin, 4) for n in shape)
    edges = pixel if part else (pixel[0] * thin, pixel[1] * thin)
    scale = math.sqrt(math.prod(drawn_shape) / math.prod(shape)) if part else 1.0
    rng = np.random.default_rng(0)
    x, y = (np.arange(n, dtype=float) for n in drawn_shape)
    alike = (z if part else z[::thin, ::thin])[: drawn_shape[0], : drawn_shape[1]]
    found, spectra = [], []
    for _ in range(draws):
        drawn = _drawn(drawn_shape, edges, density, values["rms"], rng)
        drawn[np.isnan(alike)] = np.nan
        drawn = drawn - fit_polynomial(x, y, drawn, 1)(x, y)
        found.append(estimate(drawn, edges)[0])
        spectra.append(Spectrum.of(drawn, edges).C)
    misfit = _misfit(Spectrum.of(alike, edges), np.array(spectra))
    estimates = {
        name: value
        + scale * (np.array([_near(draw.get(name, value), value, name) for draw in found]) - value)
        for name, value in values.items()
    }
    return estimates, misfit


def _misfit(own: Spectrum, drawn: Array) -> tuple[float, float]:
    """Return the rms of ln(C / mean drawn C) over rings that carry slopes: of the map, of drawn ones."""
    power = np.cumsum(own.count * own.q**2 * own.C)
    use = slice(1, max(int(np.searchsorted(power, _CARRIED * power[-1])) + 1, 4))  # the plane is subtracted
    floor = np.finfo(float).tiny
    mean = np.log(np.maximum(drawn.mean(axis=0), floor))
    away = [float(np.sqrt(np.mean((np.log(np.maximum(C, floor)) - mean)[use] ** 2))) for C in (own.C, *drawn)]
    return away[0], float(np.mean(away[1:]))


def _near(drawn: float, value: float, name: str) -> float:
    """Return the angle nearest to ``value``: angles of a lay repeat with pi."""
    return value + (drawn - value + math.pi / 2) % math.pi - math.pi / 2 if name == "lay" else drawn


def _drawn(
    shape: tuple[int, ...],
    pixel: Pixel,
    density: Callable[[Array, Array], Array],
    rms: float,
    rng: np.random.Generator,
) -> Array:
    """Return a Gaussian map of that spectrum's shape and ensemble rms: part of one of twice its period."""
    double = tuple(scipy.fft.next_fast_len(2 * n, real=True) for n in shape)
    qx = 2 * np.pi * scipy.fft.fftfreq(double[0], pixel[0])[:, None]
    qy = 2 * np.pi * scipy.fft.rfftfreq(double[1], pixel[1])[None, :]
    full = density(qx, 2 * np.pi * scipy.fft.fftfreq(double[1], pixel[1])[None, :])
    noise = scipy.fft.rfft2(rng.normal(size=double))
    variance = float(full.sum()) / math.prod(double)
    z = scipy.fft.irfft2(noise * np.sqrt(density(qx, qy) / variance), s=double)
    return np.asarray(rms * z[: shape[0], : shape[1]])
