"""README's scene, its map of contact pressure and two numbers. Usage: first_result.py [GRID] [PICTURE]"""

import sys

import matplotlib.pyplot as plt

import refimpl as rf

GRID = int(sys.argv[1]) if len(sys.argv) > 1 else 256
PICTURE = sys.argv[2] if len(sys.argv) > 2 else "first_result.png"

steel, copper = rf.Material(E=200e9, nu=0.30), rf.Material(E=118e9, nu=0.30, hardness=0.8e9)
ball = rf.Sphere(radius=0.14) + rf.GaussianRoughness(rms=0.084e-6, correlation_length=104e-6, seed=1)
flat = rf.GaussianRoughness(rms=0.3e-6, correlation_length=104e-6, seed=2)
scene = rf.Scene(upper=rf.Body(steel, ball), lower=rf.Body(copper, flat),
                 friction=rf.Friction(tau=15e6, beta=0.08), load=70.0, side=1.8e-3)  # fmt: skip
s = rf.solve(scene, grid=GRID)
mu, bar = s.friction_coefficient_corrected, s.error("friction_coefficient_corrected")
area, area_bar = s.contact_area_corrected * 1e6, s.error("contact_area_corrected") * 1e6
print(f"mu = {mu:.4f} +- {bar:.4f}, A = {area:.3f} +- {area_bar:.3f} mm^2 ({s.status.value})")

figure, axes = plt.subplots(figsize=(5.2, 4.6), layout="constrained")
image = axes.imshow(
    s.pressure.T / 1e9, origin="lower", extent=(-0.9, 0.9, -0.9, 0.9), cmap="magma", interpolation="none"
)
figure.colorbar(image, label="contact pressure (GPa)")
axes.set(xlabel="x, along the sliding (mm)", ylabel="y (mm)", xlim=(-0.7, 0.7), ylim=(-0.7, 0.7))
numbers = f"mu = {mu:.4f} ± {bar:.4f}, A = {area:.3f} ± {area_bar:.3f} mm²"
axes.set_title(f"{numbers}\npressures capped at {copper.hardness / 1e9:g} GPa")
figure.savefig(PICTURE, dpi=100)
