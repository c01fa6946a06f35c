"""Published experiments against predictions: measured data with their sources, scenes, and the comparison."""
