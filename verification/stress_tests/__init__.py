"""Extremes: every axis driven until something gives, each state judged by an independent oracle."""
