"""A map and a ball on it (docs/measured-surfaces.md). Usage: measured_map.py [GRID] [PICTURE]"""

import sys
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import refimpl as rf

GRID = int(sys.argv[1]) if len(sys.argv) > 1 else 200
PICTURE = sys.argv[2] if len(sys.argv) > 2 else "measured_map.png"

rng = np.random.default_rng(3)
n, pixel = 200, 1.5e-6
q = 2 * np.pi * np.hypot(*np.meshgrid(*2 * [np.fft.fftfreq(n, pixel)], indexing="ij"))
z = np.fft.ifft2(np.fft.fft2(rng.normal(size=(n, n))) * np.exp(-((q * 30e-6) ** 2) / 18.4)).real
z *= 0.4e-6 / z.std()
z += 2e-3 * pixel * np.arange(n)[:, None]  # tilt
z[20:26, 150:157] = np.nan  # not measured
specimen = Path(tempfile.mkdtemp()) / "specimen.npy"
np.save(specimen, z)
ball = rf.Body(rf.Material(E=200e9, nu=0.30), rf.Sphere(radius=0.01))
flat = rf.Body(rf.Material(E=3e9, nu=0.38), rf.MeasuredSurface(specimen, unit="m", pixel_size=pixel))
s = rf.solve(rf.Scene(ball, flat, rf.Friction(tau=1e6, beta=0.1), load=0.05), grid=GRID)
mu, bar = s.friction_coefficient_corrected, s.error("friction_coefficient_corrected")
print(f"mu = {mu:.4f} +- {bar:.4f}, {s.status.value}")

figure, (top, below) = plt.subplots(2, 1, figsize=(5.2, 7.4), layout="constrained")
look = {"origin": "lower", "extent": (0, 300, 0, 300)}
figure.colorbar(top.imshow(1e6 * z.T, cmap="cividis", **look), ax=top, label="height (µm)")
image = below.imshow(s.pressure.T / 1e6, cmap="magma", interpolation="none", **look)
figure.colorbar(image, ax=below, label="contact pressure (MPa)")
top.set(title="map", ylabel="y (µm)")
below.set(title=f"contact: mu = {mu:.4f} ± {bar:.4f}", xlabel="x, along the sliding (µm)", ylabel="y (µm)")
figure.savefig(PICTURE, dpi=100)
