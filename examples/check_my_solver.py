"""A right and a wrong solver, run through the suite. Usage: check_my_solver.py [ID-GLOB] [PICTURE]"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import nnls

from refimpl.kernels import normal_integral
from verification.solver_suite import suite
from verification.solver_suite.protocol import Abilities, Answer, ContactProblem

ONLY = sys.argv[1] if len(sys.argv) > 1 else "solver/[!d]*"
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


def too_stiff(problem: ContactProblem) -> Answer:
    """The same on a half-space that is 1 % too stiff."""
    return Answer(1.01 * my_solver(problem).pressure, True)


my_solver.abilities = too_stiff.abilities = Abilities(periodic=False, load=False, largest=32)
ran, wrong = (
    [r for r in suite.run(solver, [ONLY]) if r.status != "unavailable"] for solver in (my_solver, too_stiff)
)
for r in ran:
    print(f"{r.status:5} {r.id:36} {r.note if r.error is None else f'{r.error:.1e} of {r.tolerance:.1e}'}")

figure, axes = plt.subplots(figsize=(5.6, 0.45 * len(ran) + 1.6), layout="constrained")
for label, results, shift in (("right", ran, -0.2), ("1 % too stiff", wrong, 0.2)):
    shares = [max((r.error or 0) / (r.tolerance or 1), 1e-9) for r in results]
    axes.barh(np.arange(len(shares)) + shift, shares, height=0.4, label=label)
axes.set_yticks(range(len(ran)), [r.id.partition("/")[2] for r in ran])
axes.axvline(1, color="k", ls="--", lw=1)
figure.legend(loc="outside upper center", ncols=2)
axes.set(xscale="log", xlabel="error over tolerance; below 1: pass", ylim=(len(ran) - 0.4, -0.6))
axes.set_xticks([1e-8, 1e-4, 1, 1e4], ["1e-8", "1e-4", "1", "1e4"])
figure.savefig(PICTURE, dpi=100)
