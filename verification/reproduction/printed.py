"""Numbers that the paper prints (SI units), as evidence to be tested; nothing here is computed by us."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

SIDE = 1.61e-3  # m, section 5
LOADS = (14.0, 42.0, 70.0)  # N, section 6.1
CORRELATION_LENGTH = 104e-6  # m, section 6.1: where the autocorrelation is 10 %
RESOLUTION = 3.15e-6  # m, epsilon of section 6.1
LENGTH_IN_ELEMENTS = 33  # l of Eq. (9)
SPHERE_RMS = 0.084e-6  # m, section 6.1
FLAT_RMS = (0.084e-6, 1.680e-6)  # m, the range of section 6.1
QUOTED_SLOPES = {0.084e-6: 0.125, 1.680e-6: 2.5}  # degrees, section 6.1
HARDNESS = 800e6  # Pa, of copper, section 8
HERTZ_RADIUS, HERTZ_PRESSURE = 0.452e-3, 163.9e6  # m, Pa, caption of Fig. 6
FIG6_RMS = (0.068e-6, 0.511e-6, 2.69e-6)  # m, equivalent roughnesses of Fig. 6
LOWEST_FRICTION = 0.1  # Eq. (11), section 8
CRITICAL_RMS = 0.5e-6  # m, where psi reaches 1 and friction levels off, section 8
AREA_FLUCTUATION, FRICTION_FLUCTUATION = 0.075, 0.010  # section 8, relative
LARGEST_SLOPE = 6.5  # degrees, Appendix A

MESHES = (128, 256, 512)


class Column(NamedTuple):
    """A roughness of Table 3: A (m^2), mu and f_max (Pa) on the three meshes."""

    flat_rms: float
    sphere_rms: float
    contact_area: tuple[float, float, float]
    friction_coefficient: tuple[float, float, float]
    max_pressure: tuple[float, float, float]

    @property
    def equivalent_rms(self) -> float:
        """sigma_e (m)."""
        return float(np.hypot(self.flat_rms, self.sphere_rms))


_TABLE3 = np.array(  # A / 0.1 mm^2; mu / 0.1; f_max / 0.1 GPa
    [
        [[6.54, 6.44, 6.43], [2.20, 2.19, 2.18], [1.63, 1.64, 1.64]],
        [[1.35, 1.26, 1.22], [1.09, 1.07, 1.06], [17.9, 18.5, 19.1]],
        [[0.77, 0.71, 0.70], [1.01, 0.97, 0.95], [30.8, 31.4, 32.1]],
        [[0.50, 0.45, 0.44], [0.94, 0.91, 0.89], [50.2, 52.1, 52.8]],
    ]
)
_ROUGHNESS = ((0.0, 0.0), (0.504e-6, 0.084e-6), (1.008e-6, 0.084e-6), (1.680e-6, 0.084e-6))
_SI = np.array([1e-7, 0.1, 1e8])[:, None]
TABLE3 = tuple(
    Column(*rms, *(tuple(float(f"{v:.6g}") for v in row) for row in rows * _SI))  # type: ignore[arg-type]  # three meshes each
    for rms, rows in zip(_ROUGHNESS, _TABLE3, strict=True)
)

# Table 2, "matrix inversion by FFT": grid, contact points at the start and at the end
TABLE2 = ((100, 9801, 1821), (128, 14697, 4371), (256, 59171, 17383), (512, 23715, 68951))
TABLE2_HOURS = (0.07, 0.42, 7.21, 24 * 2.1)
