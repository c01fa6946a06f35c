"""The model's equations on a grid: problem, elasticity, friction law, slopes, forces, certificate."""
