"""How a measured surface lies: a raised letter F and the keys that turn it. Usage: axes.py [PICTURE]"""

import sys
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import refimpl as rf

PICTURE = sys.argv[1] if len(sys.argv) > 1 else "axes.png"
F = np.zeros((12, 16))  # F[i, j]: x to the right along i, y up along j
F[3:5, 2:14] = F[3:10, 12:14] = F[3:8, 7:9] = 1.0
WAYS = {
    "the file, from outside the body": {},
    'mirror = "x"': {"mirror": "x"},
    "rotate_deg = 90": {"rotate_deg": 90},
    "replica = true": {"replica": True},
    "on the upper body (turn_over)": {"turn_over": True},
}

figure, axes = plt.subplots(1, len(WAYS), figsize=(12.5, 3.1), layout="constrained")
with tempfile.TemporaryDirectory() as folder:
    np.save(Path(folder) / "F.npy", F)
    for ax, (title, keys) in zip(axes, WAYS.items(), strict=True):
        found = rf.inspect(Path(folder) / "F.npy", unit="um", pixel_size=1e-6, level="none", **keys)
        nx, ny = found.z.shape
        picture = ax.imshow(
            found.z.T * 1e6, origin="lower", extent=(0, nx, 0, ny), vmin=-1, vmax=1, cmap="RdBu_r"
        )
        ax.set(title=title, xlabel="x (µm)", ylabel="y (µm)", xlim=(0, 16), ylim=(0, 16))
        ax.title.set_fontsize(9)
        print(
            f"{title}: {nx} x {ny} points, z from {found.z.min() * 1e6:+.0f} to {found.z.max() * 1e6:+.0f} um"
        )
figure.colorbar(picture, ax=axes, label="z (µm)")
figure.savefig(PICTURE, dpi=90)
