"""A ball on a rough polymer: mu with an error bar, in parts. Usage: rough_friction.py [ACCURACY] [PICTURE]"""

import sys

import matplotlib.pyplot as plt

import refimpl as rf

ACCURACY = float(sys.argv[1]) if len(sys.argv) > 1 else 0.003
PICTURE = sys.argv[2] if len(sys.argv) > 2 else "rough_friction.png"

steel, polymer = rf.Material(E=200e9, nu=0.30), rf.Material(E=2.5e9, nu=0.38, hardness=0.05e9)
rough = rf.GaussianRoughness(rms=0.8e-6, correlation_length=150e-6, seed=3)
ball = rf.Body(steel, rf.Sphere(radius=0.05))
scene = rf.Scene(ball, rf.Body(polymer, rough), rf.Friction(tau=0.35e6, beta=0.12), load=5.0, side=2e-3)
found = rf.solve(scene, accuracy=ACCURACY)
mu, area = found.friction_coefficient_corrected, found.contact_area_corrected
parts = found.uncertainty["friction_coefficient_corrected"]
print(f"{found.status.value} on {found.grid}")
print(f"mu = {mu:.4f} +- {sum(parts.values()):.4f}")
print(f"A  = {area * 1e6:.4f} +- {found.error('contact_area_corrected') * 1e6:.4f} mm^2")

figure, (top, below) = plt.subplots(2, 1, figsize=(5.6, 6.1), layout="constrained", height_ratios=(4, 1.3))
image = top.imshow(found.pressure.T / 1e6, origin="lower", extent=(-1, 1, -1, 1), cmap="magma")
figure.colorbar(image, ax=top, label="contact pressure (MPa)")
top.set(xlabel="x, along the sliding (mm)", ylabel="y (mm)", xlim=(-0.7, 0.7), ylim=(-0.7, 0.7))
end = 0.0
for name, part in parts.items():
    share = 100 * part / mu
    below.barh(0, share, left=end, height=0.5, label=f"{name} {share:.2g} %")
    end += share
below.axvline(ACCURACY * 100, color="k", ls="--", label=f"requested {100 * ACCURACY:g} %")
below.set(xlabel="error bar of mu, in parts (% of mu)", yticks=[], ylim=(-0.4, 2.6))
below.legend(loc="upper left")
figure.savefig(PICTURE, dpi=100)
