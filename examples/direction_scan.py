"""How friction depends on the direction of sliding. Usage: direction_scan.py [GRID] [DIRECTIONS] [PICTURE]"""

import sys
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import refimpl as rf

GRID = int(sys.argv[1]) if len(sys.argv) > 1 else 64
COUNT = int(sys.argv[2]) if len(sys.argv) > 2 else 24
PICTURE = sys.argv[3] if len(sys.argv) > 3 else "direction_scan.png"

scene = rf.read_scene("metal-polymer")
angles = 2 * np.pi * np.arange(COUNT) / COUNT
found = [rf.solve(replace(scene, sliding_direction=float(phi)), grid=GRID) for phi in angles]
mu = np.array([s.friction_coefficient_corrected for s in found])
across = np.array([s.binormal_force / scene.load for s in found])
print(f"{COUNT} directions, {sum(s.status.name in ('CONVERGED', 'CYCLED') for s in found)} converged")
print(f"mu from {mu.min():.4f} to {mu.max():.4f}, Q/P from {across.min():+.4f} to {across.max():+.4f}")

figure, (upper, lower) = plt.subplots(2, 1, figsize=(5.6, 5), sharex=True, layout="constrained")
bars = [s.error("friction_coefficient_corrected") for s in found]
upper.errorbar(np.degrees(angles), mu, yerr=bars, fmt="o-", ms=4, capsize=2)
upper.set(ylabel="friction coefficient mu")
lower.plot(np.degrees(angles), across, "s-", ms=4, color="C1")
lower.axhline(0, color="k", lw=0.8)
lower.set(
    xlabel="direction of sliding (degrees)",
    ylabel="transverse force over load, Q / P",
    xticks=range(0, 361, 60),
)
figure.savefig(PICTURE, dpi=100)
