"""A solver of ten lines, run through the suite. Usage: check_my_solver.py [ID-GLOB] [PICTURE]"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import nnls

from refimpl.kernels import normal_integral
from verification.solver_suite import suite
from verification.solver_suite.protocol import Abilities, Answer, ContactProblem

ONLY = sys.argv[1] if len(sys.argv) > 1 else "solver/*"
PICTURE = sys.argv[2] if len(sys.argv) > 2 else "check_my_solver.png"


def my_solver(problem: ContactProblem) -> Answer:
    """Pressures of least energy at a prescribed approach: non-negative least squares of a Cholesky factor."""
    M, h = problem.M, problem.spacing
    x = np.arange(M) * h
    table = normal_integral(x[:, None], x[None, :], h, h) / (np.pi * problem.reduced_modulus)
    apart = np.abs(np.arange(M)[:, None] - np.arange(M)[None, :])
    A = table[apart[:, None, :, None], apart[None, :, None, :]].reshape(M**2, M**2)
    L = np.linalg.cholesky(A)
    f, _ = nnls(L.T, np.linalg.solve(L, problem.approach - problem.gap.ravel()), maxiter=20 * M**2)
    return Answer(f.reshape(problem.gap.shape), True, contact_area=np.count_nonzero(f) * h**2)


my_solver.abilities = Abilities(periodic=False, load=False, largest=32)
ran = [r for r in suite.run(my_solver, [ONLY]) if r.status != "unavailable"]
for r in ran:
    print(f"{r.status:5} {r.id:36} {r.note if r.error is None else f'{r.error:.1e} of {r.tolerance:.1e}'}")

shares = [max((r.error or 0) / (r.tolerance or 1), 1e-9) for r in ran]
figure, axes = plt.subplots(figsize=(5.6, 0.35 * len(ran) + 1.2), layout="constrained")
axes.barh([r.id.partition("/")[2] for r in ran], shares)
axes.axvline(1, color="k", ls="--", lw=1)
axes.set(xscale="log", xlabel="error over tolerance; below 1: pass")
axes.xaxis.set_major_formatter("{x:.0e}")
figure.savefig(PICTURE, dpi=100)
