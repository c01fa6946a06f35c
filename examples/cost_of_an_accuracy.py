"""Error bars of mu over the grid (docs/costs.md). Usage: cost_of_an_accuracy.py [GRIDS] [PICTURE]"""

import sys

import matplotlib.pyplot as plt

import refimpl as rf

GRIDS = [int(M) for M in (sys.argv[1] if len(sys.argv) > 1 else "32,48,64,96,128,192,256").split(",")]
PICTURE = sys.argv[2] if len(sys.argv) > 2 else "cost_of_an_accuracy.png"
MU = "friction_coefficient_corrected"
SCENES = {"table1-smooth": "o", "table1-rough": "s", "metal-polymer": "^", "rough-planes": "D"}

figure, axes = plt.subplots(figsize=(5.2, 4.4), layout="constrained")
for name, marker in SCENES.items():
    solved = [rf.solve(rf.read_scene(name), grid=grid) for grid in GRIDS]
    bars = [100 * s.error(MU) / getattr(s, MU) for s in solved]
    print(f"{name}: {', '.join(f'{bar:.2g}' for bar in bars)} % of mu")
    axes.plot(GRIDS, bars, marker=marker, label=name)
axes.axhline(2, color="k", ls="--", label="2 %")
axes.set(xlabel="elements per side", ylabel="error bar of mu (%)", xscale="log", yscale="log")
axes.set_xticks(GRIDS, [str(grid) for grid in GRIDS])
axes.minorticks_off()
axes.set_yticks([0.03, 0.1, 0.3, 1, 3, 10], ["0.03", "0.1", "0.3", "1", "3", "10"])
axes.grid(alpha=0.3)
axes.legend()
figure.savefig(PICTURE, dpi=100)
