"""A ball on rough copper, capped and elastic (docs/yield.md). Usage: capped_contact.py [GRID] [PICTURE]"""

import sys

import matplotlib.pyplot as plt

import refimpl as rf

GRID = int(sys.argv[1]) if len(sys.argv) > 1 else 256
PICTURE = sys.argv[2] if len(sys.argv) > 2 else "capped_contact.png"

ball = rf.Body(rf.Material(E=200e9, nu=0.30), rf.Sphere(radius=5e-3))
rough = rf.GaussianRoughness(rms=0.5e-6, correlation_length=30e-6, seed=2)
copper = rf.Body(rf.Material(E=118e9, nu=0.34, hardness=0.8e9), rough)
scene = rf.Scene(ball, copper, rf.Friction(tau=15e6, beta=0.08), load=50.0, side=1e-3)

figure, panels = plt.subplots(2, 1, figsize=(5.2, 7.4), layout="constrained", sharex=True)
for axes, plastic, name in zip(panels, (True, False), ("capped at 0.8 GPa", "elastic"), strict=True):
    s = rf.solve(scene, grid=GRID, plastic=plastic)
    mu, bar = s.friction_coefficient_corrected, s.error("friction_coefficient_corrected")
    print(f"{name}: mu = {mu:.4f} +- {bar:.4f}, p_max = {s.max_pressure / 1e9:.2f} GPa ({s.status.value})")
    look = {"origin": "lower", "extent": (-500, 500, -500, 500), "cmap": "magma", "interpolation": "none"}
    figure.colorbar(axes.imshow(s.pressure.T / 1e9, **look), ax=axes, label="contact pressure (GPa)")
    axes.set(title=f"{name}: mu = {mu:.4f} ± {bar:.4f}", ylabel="y (µm)", xlim=(-250, 250), ylim=(-250, 250))
panels[1].set(xlabel="x, along the sliding (µm)")
figure.savefig(PICTURE, dpi=100)
