"""Slope terms against the small-slope approximation, by a / R. Usage: small_slopes.py [GRID] [PICTURE]"""

import math
import sys

import matplotlib.pyplot as plt

import refimpl as rf

GRID = int(sys.argv[1]) if len(sys.argv) > 1 else 128
PICTURE = sys.argv[2] if len(sys.argv) > 2 else "small_slopes.png"
RADIUS, SHARES = 1e-3, (0.02, 0.05, 0.1, 0.15, 0.2, 0.26, 0.33)  # m; Hertz's contact radius over the ball's

soft, rigid = rf.Material(E=1e9, nu=0.3), rf.Material(E=math.inf, nu=0.3)
excess = []
for share in SHARES:
    a = share * RADIUS
    scene = rf.Scene(
        upper=rf.Body(rigid, rf.Sphere(RADIUS)),
        lower=rf.Body(soft, rf.Flat()),
        friction=rf.Friction(),
        load=4 * soft.plane_strain_modulus * a**3 / (3 * RADIUS),
        side=3 * a,
    )
    with_slopes, classical = (rf.solve(scene, GRID, oblique=oblique) for oblique in (True, False))
    excess.append(100 * (with_slopes.max_pressure / classical.max_pressure - 1))
    print(f"a / R = {share:.2f}: p_max {excess[-1]:+.1f} %")

figure, axes = plt.subplots(figsize=(5.2, 3.4), layout="constrained")
axes.plot(SHARES, excess, "o-")
axes.set(xlabel="contact radius over ball radius, a / R", ylabel="excess of p_max by slope terms (%)")
axes.grid(alpha=0.3)
figure.savefig(PICTURE, dpi=100)
