"""mu summed over elements and corrected with its bar over the grid. Usage: corrected_friction.py [PICTURE]"""

import sys

import matplotlib.pyplot as plt

import refimpl as rf

PICTURE = sys.argv[1] if len(sys.argv) > 1 else "corrected_friction.png"
GRIDS = (64, 96, 128, 192, 256, 384)

scene = rf.read_scene("rough-planes")
found = [rf.solve(scene, grid=M) for M in GRIDS]
raw = [s.friction_coefficient for s in found]
mu = [s.friction_coefficient_corrected for s in found]
bars = [s.error("friction_coefficient_corrected") for s in found]
for M, summed, corrected, bar in zip(GRIDS, raw, mu, bars, strict=True):
    print(f"{M:3}  summed {summed:.4f}, corrected {corrected:.4f} +- {bar:.4f}")

figure, axes = plt.subplots(figsize=(5.6, 3.6), layout="constrained")
axes.plot(GRIDS, raw, "s--", color="#D55E00", label="summed over elements, Eq. (4)")
axes.errorbar(GRIDS, mu, bars, fmt="o-", color="#0072B2", capsize=3, label="corrected, with its error bar")
axes.set(xscale="log", xlabel="elements per side", ylabel="friction coefficient")
axes.set_xticks(GRIDS, [str(M) for M in GRIDS])
axes.minorticks_off()
axes.legend()
figure.savefig(PICTURE, dpi=100)
