"""What an error costs: work and precision of every way to solve a scene, and the price list they make."""
