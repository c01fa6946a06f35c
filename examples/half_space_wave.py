"""Half-space error of a wave under a rigid flat, committed. Usage: half_space_wave.py [RESULT] [PICTURE]"""

import sys

import matplotlib.pyplot as plt
from PIL import Image

from verification.output.result_files import committed

NAME = sys.argv[1] if len(sys.argv) > 1 else "model_form"
PICTURE = sys.argv[2] if len(sys.argv) > 2 else "half_space_wave.png"

[wave] = [c for c in committed(NAME)["cases"] if c["id"] == "model-form/half-space-wave"]
slopes = wave["data"]["slope (degrees)"]
figure, panels = plt.subplots(2, 1, figsize=(5.2, 6.2), layout="constrained")
for axes, name in zip(panels, ("approach under the load", "N at the approach"), strict=True):
    found, first, stated = (
        [abs(value) for value in wave["data"][f"{name}: {part} (%)"]]
        for part in ("finite elements over half-space - 1", "first order", "stated")
    )
    axes.plot(slopes, stated, "--", color="#D55E00", label="stated error")
    axes.plot(slopes, first, "-", color="#0072B2", label="first order")
    axes.plot(slopes, found, "o", color="black", label="finite elements")
    axes.set(xlabel="maximum slope (degrees)", ylabel="|change| / half-space (%)", title=name, xlim=0, ylim=0)
    axes.grid(alpha=0.3)
    at = slopes.index(15.0)
    print(f"15 degrees, {name}: {found[at]:.1f} %, first order {first[at]:.1f}, stated {stated[at]:.1f}")
panels[0].legend(frameon=False)
figure.savefig(PICTURE, dpi=100)
Image.open(PICTURE).convert("RGB").quantize(64).save(PICTURE, optimize=True)
