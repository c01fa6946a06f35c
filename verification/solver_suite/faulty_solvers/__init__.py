"""Solvers that are wrong on purpose, each in one way: the suite's own test."""
