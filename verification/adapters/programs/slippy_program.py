"""SlipPY 0.5.2 as a program: `PYTHON slippy_program.py DIRECTORY`, by files as in docs/the-suites-problem.md.

It has an interpreter of its own (see `verification.adapters.slippy`), so this file imports nothing of this
package. The Polonsky-Keer solver gets the influence matrix in space where the half-space is free
(``use_frequency_domain=False``; its default is that of a periodic one), else the one by frequencies.
"""

import contextlib
import importlib
import json
import sys
from pathlib import Path

import numpy as np

STEP = 1e-10  # change of the pressures per iteration, over the load, at which its iteration ends
ITERATIONS = 5000


def main(folder: Path, spatial: bool = True) -> None:
    """Solve the problem of a folder, under a load, without friction, on square elements."""
    problem = json.loads((folder / "problem.json").read_text(encoding="utf-8"))
    gap = np.loadtxt(folder / "gap.csv", delimiter=",", ndmin=2)
    core = importlib.import_module("slippy.core")
    periodic, h = bool(problem["periodic"]), problem["spacing"]
    kind = {"zero_frequency_value": 0.0} if periodic else {"use_frequency_domain": not spatial}
    body = core.Elastic("body", {"E": problem["reduced_modulus"], "v": 0.0}, **kind)  # on a rigid one
    span = tuple(n if periodic else 2 * n for n in gap.shape)
    influence = body.influence_matrix(components=["zz"], grid_spacing=[h, h], span=span)["zz"]
    convolve = core.plan_convolve(gap, influence, None, circular=(periodic, periodic))
    failed, pressure, _ = core.polonsky_and_keer(
        convolve, np.ones_like(gap), gap, problem["value"], h, eps_0=STEP, max_it=ITERATIONS
    )
    np.savetxt(folder / "pressure.csv", pressure, fmt="%.17g", delimiter=",")
    (folder / "answer.json").write_text(json.dumps({"converged": not failed}), encoding="utf-8")


if __name__ == "__main__":
    with contextlib.redirect_stdout(sys.stderr):
        main(Path(sys.argv[-1]), spatial="--frequency" not in sys.argv)
