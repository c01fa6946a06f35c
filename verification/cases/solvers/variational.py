"""Table 2: the paper's scheme and the production solver against general minimisers of the energy."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from reports.result_files import read_result
from verification.framework.case import Measured
from verification.framework.registry import case
from verification.framework.verdict import Verdict, judged
from verification.variational.energy import Energy, frictionless, table2_scene
from verification.variational.minimisers import MINIMISERS, Minimum, interior_point
from verification.variational.timing import Contact, growth, measure, table

COMMITTED = Path(__file__).resolve().parents[3] / "reports" / "results" / "table2.json.gz"
SOURCE = "paper Table 2; the principle: Kalker and van Randen 1972, Tian and Bhushan 1996"
M_QUICK = 32


@cache
def reference() -> rf.Solution:
    """The dense reference of Table 2's scene: pivoting on Eq. (7), no minimiser."""
    return rf.solve(table2_scene(), grid=M_QUICK, method="dense", oblique=False)


@cache
def minimum(name: str) -> tuple[Array, Minimum]:
    """Pressure (Pa) and minimum of one method at the reference's approach."""
    energy = Energy(frictionless(table2_scene(), M_QUICK, reference().approach))
    found = MINIMISERS[name](energy)
    return energy.pressure(found.x), found


def departure(name: str) -> Measured:
    """Largest difference of a method's pressure from the reference, over the peak."""
    pressure, found = minimum(name)
    error = float(np.abs(pressure - reference().pressure).max() / reference().max_pressure)
    return Measured(error, data={f"operations: {k}": v for k, v in found.operations.items()})


@case("variational/nnls", metric="at_most", tolerance=2e-12, source=SOURCE)
def nnls_agrees() -> Measured:
    """Least squares over positive pressures give the contact.

    Claim: Non-negative least squares on the Cholesky factor of [a] returns the dense reference's pressure
    Tolerance: rounding of a Cholesky factor: n eps cond(a) = 492 * 1.1e-16 * 37 = 2e-12 of the peak; measured
    6e-15
    """
    return departure("NNLS")


@case("variational/quasi-newton", metric="at_most", tolerance=1.2e-5, source=SOURCE)
def quasi_newton_agrees() -> Measured:
    """A bound-constrained quasi-Newton method gives the contact.

    Claim: L-BFGS-B with products by FFT returns the dense reference's pressure
    Tolerance: it stops at a penetration of 1e-6 of the approach; over [a]'s least eigenvalue, 1.83, and the
    peak, 0.049 (both in units of the problem), that is 1.1e-5 of the peak; measured 2.6e-6
    """
    return departure("L-BFGS-B")


@case("variational/interior-point", metric="at_most", tolerance=2.1e-4, source=SOURCE)
def interior_point_agrees() -> Measured:
    """A quadratic program gives the contact.

    Claim: PIQP on the dense matrix returns the dense reference's pressure
    Tolerance: its duality gap of 1e-10 allows sqrt(2e-10 / 1.83) / 0.049 = 2.1e-4 of the peak (least
    eigenvalue and peak as above); measured 9e-6
    """
    return departure("PIQP")


@case("variational/same-contact", metric="equal", tolerance=0.0, source=SOURCE)
def one_contact() -> Measured:
    """All minimisers find one contact.

    Claim: NNLS, L-BFGS-B, PIQP, the paper's scheme, FFT and dense solvers load the same elements
    Tolerance: the solution is unique (a is positive definite), and no element is in doubt at this grid: a set
    has no tolerance
    """
    loaded = reference().contact
    sets = {name: minimum(name)[0] > 0 for name in MINIMISERS}
    for method in ("fft", "paper"):
        sets[method] = rf.solve(table2_scene(), grid=M_QUICK, method=method, oblique=False).contact
    differing = {name: int(np.count_nonzero(found != loaded)) for name, found in sets.items()}
    energy = Energy(frictionless(table2_scene(), M_QUICK, reference().approach))
    points = {"initial": len(energy.depth), "final": int(np.count_nonzero(loaded))}
    return Measured(max(differing.values()), 0.0, unit="elements", data=points | differing)


@case("variational/load-multiplier", metric="relative", tolerance=1e-8)
def approach_is_multiplier() -> Measured:
    """The approach is the multiplier of the load.

    Claim: Minimised under sum f dA = P, the energy's multiplier is the dense reference's approach
    Source: Johnson 1985, section 5.8; Kalker 1990
    Tolerance: PIQP's residuals of 1e-10 of the approach, times 100 because they are weighted by the
    pressure's own error; measured 1e-11
    """
    assumed = 1.2 * reference().approach
    energy = Energy(frictionless(table2_scene(), M_QUICK, assumed))
    found = interior_point(energy, load=table2_scene().load)
    return Measured(found.approach * assumed, reference().approach, unit="m")


@case("variational/transform-work", metric="at_most", tolerance=1.0)
def transform_work() -> Measured:
    """With products by FFT, a general minimiser needs no more work than the paper's scheme.

    Claim: Transformed points n log2 n of L-BFGS-B over those of the paper's scheme, for the same contact
    Source: {SOURCE}; the paper credits its scheme with the advantage
    Tolerance: the statement itself: no more work; counts do not depend on the machine. Measured 0.4
    """
    contact = Contact.of(table2_scene(), 64)
    work = {method: contact.run(method)[1]["n log2 n"] for method in ("paper", "L-BFGS-B", "production")}
    share = work["L-BFGS-B"] / work["paper"]
    sentence = (
        f"L-BFGS-B on the energy, with products by FFT, does {share:.2f} of the scheme's transform work. "
        "What costs no less than Table 2's rival did is a solver with the matrix (table2-rerun): the FFT is "
        "the advantage, and a variational method may have it too"
    )
    return judged(Verdict.CONDITIONAL, sentence, share, data={f"n log2 n: {k}": v for k, v in work.items()})


@case("variational/table2-rerun", metric="at_least", tolerance=13.3, tier="full")
def table2_rerun() -> Measured:
    """Table 2's ratio, measured here and now.

    Claim: Processor time of a general solver with matrix (NNLS) over the paper's scheme's; printed: 13 to 14
    Source: paper Table 2
    Tolerance: the lower of the printed ratios, 96 h / 7.21 h. Ours grows with the grid and depends on machine
    and BLAS; on 64 x 64 it is several times that, so that a busy machine does not decide
    """
    rows = measure((48, 64), ("paper", "production", *MINIMISERS), 2, 30.0)
    found = table(rows)
    ratios = found["ratio to paper"]
    assert isinstance(ratios, dict)
    data = {f"{name} at {M}": ratio for name, by_grid in ratios.items() for M, ratio in by_grid.items()}
    return Measured(ratios["NNLS"]["64"], data=data)


@case("variational/table2-growth", metric="at_least", tolerance=1.0, tier="full")
def table2_growth() -> Measured:
    """Growth of computing time with the number of elements.

    Claim: The time of a solver with matrix (NNLS) grows faster with the elements than that of the scheme
    Source: paper Table 2; operation counts
    Tolerance: difference of exponents in the number of elements n: a factorisation takes n^3, products by FFT
    n log n times some sqrt(n) iterations, a difference of 1.5; the active set of the least grids takes 0.5 of
    that. The committed run is judged
    """
    found = read_result(COMMITTED)
    growths = found["growth"]
    data: dict[str, object] = {}
    for name in growths:
        rows = [row for row in found["rows"] if row["method"] == name]
        data[f"{name}: M"] = [row["M"] for row in rows]
        data[f"{name}: s"] = [min(row["cpu"]) for row in rows]
        data[f"{name}: exponent"] = growths[name]
    scheme = [row for row in found["rows"] if row["method"] == "paper" and row["M"] >= 64]
    hours, grids = found["printed"]["hours"], found["printed"]["M"]
    shared = [k for k, other in enumerate(hours["variational"]) if other is not None]
    for name in ("paper", "variational"):
        data[f"printed {name}: exponent on the shared grids"] = growth(
            [grids[k] for k in shared], [hours[name][k] for k in shared]
        )
    again = growth([row["M"] for row in scheme], [min(row["cpu"]) for row in scheme])
    return Measured(growths["NNLS"] - again, data=data, note=f"commit {found['provenance']['commit']}")
