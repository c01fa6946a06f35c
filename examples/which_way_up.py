"""A measured map on the lower and on the upper body, seen from above. Usage: which_way_up.py [GRID] [PICTURE]"""

import sys

import matplotlib.pyplot as plt
import numpy as np

import refimpl as rf

GRID = int(sys.argv[1]) if len(sys.argv) > 1 else 96
PICTURE = sys.argv[2] if len(sys.argv) > 2 else "which_way_up.png"

# A letter F, 1 um high, and a bump on its upper arm: x to the right, y up, heights out of the material
x, y = np.meshgrid((np.arange(96) + 0.5) / 48 - 1, (np.arange(64) + 0.5) / 48 - 2 / 3, indexing="ij")
letter = ((abs(x + 0.4) < 0.1) & (abs(y) < 0.5)) | ((abs(x) < 0.5) & (abs(y - 0.4) < 0.1))
letter |= (abs(x + 0.1) < 0.4) & (abs(y) < 0.1)
np.save("letter.npy", letter + np.exp(-60 * ((x - 0.4) ** 2 + (y - 0.4) ** 2)))
measured = rf.MeasuredSurface("letter.npy", unit="um", pixel_size=1e-5, level="none")
steel, friction = rf.Material(E=200e9, nu=0.3), rf.Friction(beta=0.1)
lower = rf.Scene(rf.Body(steel, rf.Flat()), rf.Body(steel, measured), friction, load=0.05)
upper = rf.Scene(rf.Body(steel, measured), rf.Body(steel, rf.Flat()), friction, load=0.05)

figure, panels = plt.subplots(1, 3, figsize=(10, 3.2), layout="constrained", sharey=True)
grid = lower.grid(GRID)
views = {"the instrument's picture, from outside": np.load("letter.npy") * 1e-6}
views |= {"on the lower body: z(x, y)": lower.sampled(grid)[0]}
views |= {"on the upper body: -z(x, -y)": upper.sampled(grid)[1]}
for axes, (title, z) in zip(panels, views.items(), strict=True):
    image = axes.imshow((z - z.mean()).T * 1e6, origin="lower", extent=(-0.48, 0.48, -0.32, 0.32), cmap="RdBu")
    axes.set(title=title, xlabel="x (mm)")
for axes, scene, name in ((panels[1], lower, "lower"), (panels[2], upper, "upper")):
    found = rf.solve(scene, GRID)
    i, j = np.unravel_index(np.argmax(found.pressure), found.pressure.shape)
    px, py = (grid.x[i] - grid.lengths[0] / 2) * 1e3, (grid.y[j] - grid.lengths[1] / 2) * 1e3
    print(f"on the {name} body it touches first at x = {px:+.2f}, y = {py:+.2f} mm")
    axes.plot(px, py, "k*", ms=10)
    for end, text in (((0.18, 0.0), "sliding\ndirection"), ((0.0, 0.18), "Q > 0")):
        axes.annotate("", (0.2 + end[0], -0.2 + end[1]), (0.2, -0.2), arrowprops={"arrowstyle": "->"})
        axes.text(0.22 + end[0], -0.2 + end[1], text, fontsize=8, va="center")
figure.colorbar(image, ax=panels, label="height, upwards (um)")
figure.savefig(PICTURE, dpi=100)
