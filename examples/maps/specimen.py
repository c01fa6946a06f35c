"""Write specimen.txt: a map of 300 um as an instrument writes it, with a header, a tilt and a hole."""

import numpy as np

rng = np.random.default_rng(3)
n, pixel = 200, 1.5e-6  # m
q = 2 * np.pi * np.hypot(*np.meshgrid(*2 * [np.fft.fftfreq(n, pixel)], indexing="ij"))
z = np.fft.ifft2(np.fft.fft2(rng.normal(size=(n, n))) * np.exp(-((q * 30e-6) ** 2) / 18.4)).real
z *= 0.4e-6 / z.std()  # Gaussian roughness, autocorrelation of 10 % after 30 um
z += 2e-3 * pixel * np.arange(n)[:, None]  # tilt
z[20:26, 150:157] = np.nan  # not measured
edge = n * pixel * 1e6
head = f"# Channel: Height\n# Width: {edge:.1f} µm\n# Height: {edge:.1f} µm\n# Value units: m"
np.savetxt("specimen.txt", z.T[::-1], header=head, comments="", encoding="utf-8")
