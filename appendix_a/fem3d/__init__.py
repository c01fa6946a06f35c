"""Three-dimensional elasticity of a wavy body under one square element of pressure.

wavy           the surface
mesh, space    graded block, triquadratic nodes
elasticity     element matrices, operator, load
solver         conjugate gradients with a separable preconditioner
patch          exact flat and tilted half-space fields
surface        one solution on one mesh
fields         mesh and displacements through meshio
coefficients   wavy against flat, extrapolated, with stated errors: start here
leading_order  what first-order theory says
study          the table of all points
table          that table read: errors over the slope, one body and a pair
"""
