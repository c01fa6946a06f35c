"""Two wavy elastic bodies in sliding contact by finite elements in plane strain: the model's judge.

What is exact and what is linearised:

- Each body is linear elastic with small strains, in equilibrium on its undeformed wavy shape: stiffness and
  compliance are those of the true sinusoidal boundary, not of a half-plane.  At medium loads strains reach
  half the maximum slope, so a nonlinear body would differ by relative terms of first order in the slope, as
  large as the first-order part of the differences found here.  The judge is linear elasticity, as the model.
- The interface is not linearised.  Pressure acts along the normal and friction along the tangent of the
  deformed surface, per unit of its deformed length; points touch where deformation has taken them, with
  their tangential displacements; the resultants are those of these tractions.
"""
