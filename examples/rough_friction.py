"""Friction of a rough contact with an error bar, in parts. Usage: rough_friction.py [ACCURACY] [PICTURE]"""

import sys

import matplotlib.pyplot as plt

import refimpl as rf

ACCURACY = float(sys.argv[1]) if len(sys.argv) > 1 else 0.02
PICTURE = sys.argv[2] if len(sys.argv) > 2 else "rough_friction.png"

scene = rf.read_scene("table1-rough")
found = rf.solve(scene, accuracy=ACCURACY)
mu, area = found.friction_coefficient_corrected, found.contact_area_corrected
print(f"{found.status.value} on {found.grid}")
print(f"mu = {mu:.4f} +- {found.error('friction_coefficient_corrected'):.4f}")
print(f"A  = {area * 1e6:.4f} +- {found.error('contact_area_corrected') * 1e6:.4f} mm^2")

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.9), layout="constrained", width_ratios=(1.2, 1))
half = 0.5e3 * scene.side
pressures = left.imshow(
    found.pressure.T / 1e9, origin="lower", extent=(-half, half, -half, half), cmap="magma"
)
figure.colorbar(pressures, ax=left, label="pressure (GPa)")
left.set(xlabel="x, along the sliding (mm)", ylabel="y (mm)")
end = 0.0
for k, (name, part) in enumerate(found.uncertainty["friction_coefficient_corrected"].items()):
    right.barh(0, part / mu * 100, left=end, height=0.4, color=f"C{k}", label=name)
    end += part / mu * 100
right.axvline(ACCURACY * 100, color="k", ls="--", lw=1, label="requested")
right.set(xlabel="error bar of mu, in parts (per cent of mu)", yticks=[], ylim=(-0.5, 0.9))
right.legend(loc="upper left", ncols=2)
figure.savefig(PICTURE, dpi=100)
