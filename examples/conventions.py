"""Axes, directions and signs: a ball slides over a soft flat. Usage: conventions.py [GRID] [PICTURE]"""

import sys
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import refimpl as rf

GRID = int(sys.argv[1]) if len(sys.argv) > 1 else 97
PICTURE = sys.argv[2] if len(sys.argv) > 2 else "conventions.png"
ORANGE, BLUE, phi = "#D55E00", "#0072B2", np.radians(30)
ball = rf.Body(rf.Material(E=float("inf"), nu=0.3), rf.Sphere(5e-3))
flat = rf.Body(rf.Material(E=2e6, nu=0.3), rf.Flat())
scene = rf.Scene(ball, flat, rf.Friction(beta=0.6), load=0.12, side=5e-3, sliding_direction=phi)
turned, s = rf.solve(scene, GRID), rf.solve(replace(scene, sliding_direction=0.0), GRID)
x = (s.grid.x - 2.5e-3) * 1e3
ahead, tilt = np.average(x, weights=s.pressure.sum(axis=1)), s.slopes.theta_x[s.contact & (x[:, None] > 0)]
print(f"centre of pressure at x = {ahead:+.3f} mm, theta_x in front up to {tilt.max():+.3f}")
figure, (top, side) = plt.subplots(2, 1, figsize=(5.6, 8), layout="constrained", height_ratios=(1.4, 1))
top.contourf(x, x, turned.pressure.T, 5, cmap="Greys", vmax=3 * turned.max_pressure)
top.set(xlabel="x (mm)", ylabel="y (mm)", aspect="equal", xlim=(-2, 2), ylim=(-2, 2), title="from above")
side.plot(x, s.surfaces[1][:, GRID // 2] * 1e6, color=ORANGE, label="upper body: heights upwards")
side.plot(x, s.surfaces[0][:, GRID // 2] * 1e6, color=BLUE, label="lower body: heights upwards")
arc = np.linspace(0, phi, 20)
top.plot(0.9 * np.cos(arc), 0.9 * np.sin(arc), "k", lw=1.2)
top.annotate("phi", (0.95, 0.18))
side.axvline(ahead, color="0.5", ls="--", lw=1, label="centre of pressure")
side.set(xlabel="x (mm)", ylabel="z (µm)", xlim=(-1.8, 1.8), ylim=(-250, 400))
side.set_title("section, phi = 0 (heights stretched)")
for axes, start, stop, colour, at, text in (
    (top, (0, 0), (1.3, 0.75), ORANGE, (0.6, 0.95), "sliding"),
    (top, (0, 0), (1.5, 0), "k", (1.55, -0.04), "x"),
    (top, (0, 0), (-0.75, 1.3), BLUE, (-1.9, 1.5), "Q > 0, theta_y > 0"),
    (side, (0, 290), (0.9, 290), ORANGE, (0, 310), "upper body slides"),
    (side, (-0.4, 90), (-1, 90), ORANGE, (-1.05, 110), "F on the upper"),
    (side, (0, -170), (0.9, -170), BLUE, (0, -150), "F on the lower body"),
    (side, (0, 170), (0, 20), "k", (0.04, 120), "load P"),
    (side, (0.42, -62), (0.7, 10), "k", (0.62, -100), "theta_x > 0: uphill"),
):
    axes.annotate("", stop, start, arrowprops={"arrowstyle": "-|>", "lw": 1.8, "color": colour})
    axes.annotate(text, at)
figure.legend(*side.get_legend_handles_labels(), loc="outside lower center", ncols=2)
figure.savefig(PICTURE, dpi=100)
