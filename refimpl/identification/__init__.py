"""Identification of tau and beta from measured friction: see `identify` and `read_rows`."""

from refimpl.identification.data_table import Row, read_rows
from refimpl.identification.identify import identify
from refimpl.identification.result import Identification, Interval, Prediction

__all__ = ["Identification", "Interval", "Prediction", "Row", "identify", "read_rows"]
