"""A steel ball on rough copper: docs/quick-start.md. Usage: first_scene.py [GRID] [PICTURE]"""

import sys

import matplotlib.pyplot as plt

import refimpl as rf

GRID = int(sys.argv[1]) if len(sys.argv) > 1 else 256
PICTURE = sys.argv[2] if len(sys.argv) > 2 else "first_scene.png"

ball = rf.Body(rf.Material(E=200e9, nu=0.30), rf.Sphere(radius=0.05))
rough = rf.GaussianRoughness(rms=0.4e-6, correlation_length=150e-6, seed=1)
flat = rf.Body(rf.Material(E=118e9, nu=0.34, hardness=0.8e9), rough)
s = rf.solve(rf.Scene(ball, flat, rf.Friction(tau=15e6, beta=0.08), load=20.0, side=2e-3), grid=GRID)
mu, bar = s.friction_coefficient_corrected, s.error("friction_coefficient_corrected")
print(f"mu = {mu:.4f} +- {bar:.4f}, {len(s.patches())} patches ({s.status.value})")

figure, axes = plt.subplots(figsize=(5.2, 4.4), layout="constrained")
look = {"origin": "lower", "extent": (-1, 1, -1, 1), "cmap": "magma", "interpolation": "none"}
figure.colorbar(axes.imshow(s.pressure.T / 1e6, **look), label="contact pressure (MPa)")
axes.set(xlabel="x, along the sliding (mm)", ylabel="y (mm)", xlim=(-0.4, 0.4), ylim=(-0.5, 0.3))
axes.set_title(f"mu = {mu:.4f} ± {bar:.4f}")
figure.savefig(PICTURE, dpi=100)
