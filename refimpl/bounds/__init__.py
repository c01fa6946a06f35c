"""Proven bounds of pressures, approach and load of a discrete problem."""
