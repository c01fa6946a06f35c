"""Gaussian and self-affine roughness (docs/roughness.md). Usage: two_roughnesses.py [GRID] [PICTURE]"""

import math
import sys

import matplotlib.pyplot as plt

import refimpl as rf
from refimpl.grid import Grid

GRID = int(sys.argv[1]) if len(sys.argv) > 1 else 256
PICTURE = sys.argv[2] if len(sys.argv) > 2 else "two_roughnesses.png"

ground = rf.GaussianRoughness(rms=0.5e-6, correlation_length=(200e-6, 50e-6), lay=math.radians(30), seed=1)
cuts = {"roll_off": 200e-6, "long_cut": 400e-6, "short_cut": 20e-6}
fractal = rf.SelfAffineRoughness(hurst=0.8, rms=0.5e-6, seed=1, **cuts)
grid = Grid((GRID, GRID), (1e-3, 1e-3))

figure, panels = plt.subplots(2, 1, figsize=(5.2, 7.4), layout="constrained", sharex=True)
names = ("Gaussian, lay of 30 degrees", "self-affine, Hurst exponent 0.8")
for axes, surface, name in zip(panels, (ground, fractal), names, strict=True):
    z = 1e6 * surface.heights_on(grid, (0.0, 0.0))
    print(f"{name}: rms {z.std():.2f} um")
    image = axes.imshow(z.T, origin="lower", extent=(0, 1, 0, 1), cmap="cividis", vmin=-1.5, vmax=1.5)
    axes.set(title=name, ylabel="y (mm)")
    figure.colorbar(image, ax=axes, label="height (µm)", extend="both")
panels[1].set(xlabel="x (mm)")
figure.savefig(PICTURE, dpi=100)
