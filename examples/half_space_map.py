"""Error of flat coefficients by slope and wavelength. Usage: half_space_map.py [NU] [PICTURE]"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

from refimpl import Material
from refimpl.half_space.influence_error import coefficient_error

NU = float(sys.argv[1]) if len(sys.argv) > 1 else 0.3
PICTURE = sys.argv[2] if len(sys.argv) > 2 else "half_space_map.png"
STEEL, COPPER = Material(200e9, NU), Material(118e9, NU)
PANELS = {"copper, flank": (None, 0.25), "copper, crest": (None, 0), "steel on copper": (STEEL, None)}
SLOPES, WAVELENGTHS = np.linspace(0.5, 30, 60), np.geomspace(4, 128, 40)  # degrees, elements
LEVELS, SHADES = (0.5, 1, 2, 5, 10), plt.get_cmap("cividis")(np.linspace(0, 1, 6))  # percent

figure, panels = plt.subplots(3, 1, figsize=(5.2, 7.4), layout="constrained")
for axes, (title, (upper, place)) in zip(panels, PANELS.items(), strict=True):
    error = [
        [100 * coefficient_error(s, COPPER, upper, wavelength=w, position=place) for s in np.radians(SLOPES)]
        for w in 2 * WAVELENGTHS  # half-widths of an element
    ]
    filled = axes.contourf(SLOPES, WAVELENGTHS, error, LEVELS, colors=SHADES, extend="both")
    axes.contour(SLOPES, WAVELENGTHS, error, [2], colors="white", linewidths=2)
    below = ", all below 2 %" if np.max(error) < 2 else ""
    axes.set(title=title + below, yscale="log", xlabel="maximum slope (degrees)")
    axes.set_yticks([4, 16, 64], ["4", "16", "64"])
    axes.minorticks_off()
    at = [float(np.interp(10, SLOPES, row)) for row in error]
    print(f"{title}, 10 degrees: {at[0]:.1f} % on waves of 4 elements, {at[-1]:.1f} on 128")
panels[1].set_ylabel("wavelength (elements)")
figure.colorbar(filled, ax=panels, label=f"error of the coefficient (%), nu = {NU:g}", format="%g")
figure.savefig(PICTURE, dpi=100)
Image.open(PICTURE).convert("RGB").quantize(64).save(PICTURE, optimize=True)
