"""Identification of tau and beta from measured friction: see `identify` and `read_rows`."""

from refimpl.identification.data_table import Row, read_rows
from refimpl.identification.identify import Identification, Interval, Prediction, identify

__all__ = ["Identification", "Interval", "Prediction", "Row", "identify", "read_rows"]
