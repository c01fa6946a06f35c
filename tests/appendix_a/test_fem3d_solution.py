"""The three-dimensional elements and their solver, each against another way of doing the same."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp
from skfem import Basis, BilinearForm, ElementHex2, ElementVector, MeshHex, MeshHex2
from skfem.models.elasticity import lame_parameters, linear_elasticity

from appendix_a.fem3d import solver
from appendix_a.fem3d.elasticity import Operator, mapped, patch_load, stiffness
from appendix_a.fem3d.mesh import Block, block
from appendix_a.fem3d.space import Space, space, with_midpoints
from appendix_a.fem3d.wavy import Kind, Waviness

NU = 0.3
FLAT = Waviness(0.0, 20.0, 0.0)
RNG = np.random.default_rng(20010901)


def small_block(cuts: int = 1) -> Block:
    """Graded, with the loaded element -1..1 by 0..1 as whole intervals."""
    x, y = np.array([-6.0, -2.5, -1.0, 0.0, 1.0, 2.5, 6.0]), np.array([0.0, 1.0, 2.0, 6.0])
    zeta = np.array([-6.0, -2.5, -1.0, 0.0])
    refine = lambda s: np.interp(np.arange(cuts * (s.size - 1) + 1) / cuts, np.arange(s.size), s)  # noqa: E731 - three uses
    return Block(refine(x), refine(y), refine(zeta))
