"""The result of a solve: numbers, error bars, warnings, contact patches, export."""
