"""The axes; importing this package registers them in the order of the report's table."""

from verification.extremes.axes import units as units  # isort: skip
from verification.extremes.axes import loads as loads  # isort: skip
from verification.extremes.axes import contact_sets as contact_sets  # isort: skip
from verification.extremes.axes import materials as materials  # isort: skip
from verification.extremes.axes import friction as friction  # isort: skip
from verification.extremes.axes import topography as topography  # isort: skip
from verification.extremes.axes import grids as grids  # isort: skip
from verification.extremes.axes import kernels as kernels  # isort: skip
from verification.extremes.axes import plane as plane  # isort: skip
