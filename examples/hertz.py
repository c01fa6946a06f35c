"""A steel ball on a copper flat without friction, beside Hertz (1882). Usage: hertz.py [GRID] [PICTURE]"""

import sys

import matplotlib.pyplot as plt
import numpy as np

import refimpl as rf

GRID = int(sys.argv[1]) if len(sys.argv) > 1 else 64
PICTURE = sys.argv[2] if len(sys.argv) > 2 else "hertz.png"
LOAD, RADIUS, SIDE = 70.0, 0.14, 1.61e-3

scene = rf.Scene(
    upper=rf.Body(rf.Material(E=200e9, nu=0.30), rf.Sphere(radius=RADIUS)),
    lower=rf.Body(rf.Material(E=118e9, nu=0.30), rf.Flat()),
    friction=rf.Friction(),
    load=LOAD,
    side=SIDE,
)
found = rf.solve(scene, grid=GRID)

modulus = scene.materials.reduced_modulus
contact_radius = (3 * LOAD * RADIUS / (4 * modulus)) ** (1 / 3)
peak = 3 * LOAD / (2 * np.pi * contact_radius**2)
error = found.max_pressure / peak - 1
print(
    f"{found.status.value}: peak {found.max_pressure / 1e6:.2f} MPa, {error:+.1e} of Hertz' {peak / 1e6:.2f}"
)

x = (np.arange(GRID) + 0.5) * SIDE / GRID - SIDE / 2
fine = np.linspace(-contact_radius, contact_radius, 400)
figure, axes = plt.subplots(figsize=(5.6, 3.8), layout="constrained")
axes.plot(fine * 1e3, peak / 1e6 * np.sqrt(1 - (fine / contact_radius) ** 2), "k-", lw=1, label="Hertz")
axes.plot(x * 1e3, found.pressure[:, GRID // 2] / 1e6, "o", ms=3, label=f"{GRID} x {GRID} elements")
axes.set(xlabel="x (mm)", ylabel="pressure (MPa)", xlim=np.array([-1.5, 1.5]) * contact_radius * 1e3)
axes.legend()
figure.savefig(PICTURE, dpi=100)
