"""Stress tests: every axis driven to the point of failure, each state judged by an independent oracle."""
