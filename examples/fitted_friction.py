"""tau and beta from friction (docs/identify-tau-and-beta.md). Usage: fitted_friction.py [GRID] [PICTURE]"""

import sys

import matplotlib.pyplot as plt
from matplotlib.ticker import ScalarFormatter

import refimpl as rf
from refimpl.identification import Row, identify

GRID = int(sys.argv[1]) if len(sys.argv) > 1 else 128
PICTURE = sys.argv[2] if len(sys.argv) > 2 else "fitted_friction.png"

LOADS = (5, 7.5, 11, 16, 24, 36, 54, 80)
MEASURED = (0.4103, 0.3720, 0.3337, 0.2940, 0.2788, 0.2514, 0.2253, 0.2120)
U = (0.0082, 0.0073, 0.0066, 0.0060, 0.0055, 0.0050, 0.0046, 0.0042)

rows = [Row(load, mu, u) for load, mu, u in zip(LOADS, MEASURED, U, strict=True)]
found = identify(rf.read_scene("table1-smooth"), rows, grid=GRID, loads=[2.0, 100.0])
tau, beta = found.values["tau"], found.values["beta"]
shown = f"tau = {tau.value / 1e6:.1f} MPa ({tau.low / 1e6:.1f} to {tau.high / 1e6:.1f})"
print(shown, f"beta = {beta.value:.3f} ({beta.low:.3f} to {beta.high:.3f})", sep="\n")

figure, axes = plt.subplots(figsize=(5.2, 4.2), layout="constrained")
model = sorted((p.load, p.mu.low, p.mu.value, p.mu.high) for p in found.predictions)
loads, low, mu, high = zip(*model, strict=True)
axes.fill_between(loads, low, high, alpha=0.25, label="95 % interval of the model")
axes.plot(loads, mu, label="model")
axes.errorbar(LOADS, MEASURED, [1.96 * u for u in U], fmt="ko", capsize=3, label="measured, 95 %")
axes.set(xlabel="load (N)", ylabel="friction coefficient mu", xscale="log", title=shown)
axes.set_xticks((2, 5, 10, 20, 50, 100))
axes.xaxis.set_major_formatter(ScalarFormatter())
axes.xaxis.set_minor_formatter("")
axes.legend()
figure.savefig(PICTURE, dpi=100)
