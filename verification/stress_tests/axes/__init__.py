"""The axes; importing this package registers them in the order of the report's table."""

from verification.stress_tests.axes import units as units  # isort: skip
from verification.stress_tests.axes import contacts as contacts  # isort: skip
from verification.stress_tests.axes import topography as topography  # isort: skip
from verification.stress_tests.axes import grids as grids  # isort: skip
from verification.stress_tests.axes import kernels as kernels  # isort: skip
from verification.stress_tests.axes import plane as plane  # isort: skip
