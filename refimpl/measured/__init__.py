"""Measured surfaces: instruments' files read, prepared, levelled, cut, and inspected."""

from refimpl.measured.inspection import Inspection, inspect_surface
from refimpl.measured.measured_surface import MeasuredSurface

__all__ = ["Inspection", "MeasuredSurface", "inspect_surface"]
