"""Influence of tractions on displacements: matrices, transforms, preconditioner."""
