"""Points and whole lines of a measured map that stand out: spikes of an instrument, scars of a scan."""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array, Mask
from refimpl.measured.preparation import MAD_TO_RMS, outlying

FAR = 8.0  # spreads: of Gaussian distances one in 10^15 is farther
_LEAST_LINES = 16  # lines from which their steps have a spread
_ROUNDING = 1e-9  # share of the rms height


def standing_out(z: Array, known: Mask) -> tuple[str, ...]:
    """Return notes on ``known`` points and on lines along each axis that stand out; empty for none."""
    if not known.any():
        return ()
    points, notes = int(np.count_nonzero(outlying(z, known, FAR)[0])), []
    if points:
        notes.append(
            f"{points} points stand out by more than {FAR:g} local spreads: outliers = {FAR:g} (--outliers "
            f"{FAR:g}) removes them"
        )
    for axis, values in (("x", z.T), ("y", z)):
        if lines := scars(values):
            notes.append(
                f"{lines} of {len(values)} lines along {axis} stand out as a whole (scars of a scan): "
                f'scan_lines = "{axis}" (--scan-lines {axis}) levels each; contact would run along them'
            )
    return tuple(notes)


def scars(z: Array) -> int:
    """Return how many rows lie above, or below, both neighbours by `FAR` spreads of median steps."""
    if len(z) < _LEAST_LINES:
        return 0
    steps = np.median(np.diff(z, axis=0), axis=1)
    steps = steps - np.median(steps)
    spread = max(MAD_TO_RMS * float(np.median(np.abs(steps))), _ROUNDING * float(z.std()))
    up, down = steps[:-1], -steps[1:]
    out = (up * down > 0) & (np.minimum(np.abs(up), np.abs(down)) > FAR * spread)
    return int(np.count_nonzero(out))
