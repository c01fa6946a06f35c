"""A measured map on the lower and on the upper body, from above. Usage: which_way_up.py [GRID] [PICTURE]"""

import sys

import matplotlib.pyplot as plt
import numpy as np

import refimpl as rf

GRID = int(sys.argv[1]) if len(sys.argv) > 1 else 96
PICTURE = sys.argv[2] if len(sys.argv) > 2 else "which_way_up.png"

# A letter F with a bump at its upper arm's end, as an instrument sees it: x to the right, y up, z out of it
x, y = np.meshgrid((np.arange(96) - 47.5) / 100, (np.arange(64) - 31.5) / 100, indexing="ij")
letter = (abs(x + 0.2) < 0.05) | (abs(y - 0.2) < 0.05) | ((abs(y) < 0.05) & (x < 0.1))
letter &= (abs(x) < 0.25) & (abs(y) < 0.25)
np.save("letter.npy", letter + np.exp(-300 * ((x - 0.205) ** 2 + (y - 0.205) ** 2)))
measured = rf.MeasuredSurface("letter.npy", unit="um", pixel_size=1e-5, level="none")
steel, friction = rf.Material(E=200e9, nu=0.3), rf.Friction(beta=0.1)
map_, flat = rf.Body(steel, measured), rf.Body(steel, rf.Flat())
scenes = {"lower": rf.Scene(flat, map_, friction, 0.05), "upper": rf.Scene(map_, flat, friction, 0.05)}
heights = {name: scene.sampled(scene.grid(GRID))[name == "upper"] for name, scene in scenes.items()}

figure, panels = plt.subplots(3, 1, figsize=(5.2, 7.6), layout="constrained", sharex=True)
shown = {"picture of the instrument": np.load("letter.npy") * 1e-6}
shown |= {"on the lower body: z(x, y)": heights["lower"], "on the upper body: -z(x, -y)": heights["upper"]}
for axes, (title, z) in zip(panels, shown.items(), strict=True):
    drawn, extent = (z - z.min()).T * 1e6, (-0.48, 0.48, -0.32, 0.32)
    image = axes.imshow(drawn, origin="lower", extent=extent, cmap="cividis", vmax=2)
    axes.set(title=title, xlabel="x (mm)" if axes is panels[2] else "", ylabel="y (mm)")
for axes, (name, scene) in zip(panels[1:], scenes.items(), strict=True):
    found = rf.solve(scene, GRID)
    touching = np.unravel_index(np.argmax(found.pressure), found.pressure.shape)
    px, py = ((c[k] - c.mean()) * 1e3 for c, k in zip((found.grid.x, found.grid.y), touching, strict=True))
    print(f"on the {name} body it touches first at x = {px:+.2f}, y = {py:+.2f} mm")
    axes.plot(px, py, "r*", label="touches first")
    colour = "w" if name == "lower" else "k"
    axes.quiver([0.12, 0.12], [-0.05, -0.05], [1, 0], [0, 1], color=colour, scale=8)
    axes.annotate("phi = 0", (0.25, -0.07), color=colour)
    axes.annotate("Q > 0", (0.14, 0.05), color=colour)
panels[1].legend(loc="lower right", fontsize=9)
figure.colorbar(image, ax=panels, label="z above its lowest point (µm)")
figure.savefig(PICTURE, dpi=100)
