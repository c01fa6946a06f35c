"""Cost of an error: work and precision of every configuration for a scene, and the cost-accuracy table."""
