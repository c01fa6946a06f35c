"""One run of a sweep: its inputs, their key, and the row of numbers that its solve gives."""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np

import refimpl as rf
from refimpl.scene.scene_file import scene_from_dict
from refimpl.solution.limits import roughness_slope
from refimpl.solution.model_warning import ModelWarning
from refimpl.solution.quantities import QUANTITIES
from verification.framework.threads import limited_to_one_thread

COORDINATES = (
    "realisation", "grid", "load", "upper_rms", "lower_rms", "correlation_length",
    "sliding_direction", "sliding_offset", "tau", "beta", "parameters",
)  # fmt: skip
"""What tells the runs of one study apart; SI units and rad, None where a scene has no such thing, and for the
grid where none is given. ``parameters`` is the JSON text of the numbers of materials and surfaces that the
study varies by their full names.
"""

_OF_A_RUN = (
    "residual", "friction_coefficient_cycle", "contact_area_cycle", "border_elements",
    "plasticity_index", "elements_x", "elements_y", "warnings",
)  # fmt: skip
OUTCOMES = ("status", *QUANTITIES, *(f"{name}_error" for name in QUANTITIES), *_OF_A_RUN)
"""What a run gives: the numbers of `refimpl.Solution`, and ``..._error``, their bars: inf where unbounded,
None without a rule. ``residual`` is the certificate's largest; ``..._cycle`` what an alternating contact
edge under tau leaves open; ``border_elements`` the elements in contact on the domain's border;
``plasticity_index`` Eq. (12)'s, of the sampled slopes, None without a hardness; ``elements_x``,
``elements_y`` the grid solved on; ``warnings`` the names of the limits exceeded, separated by "; ".
"""

LIBRARIES = ("numpy", "scipy", "ducc0")
"""Packages whose version may change the last digits of a run."""

CERTIFIED = (rf.Status.CONVERGED.value, rf.Status.CYCLED.value)
"""Statuses of rows whose numbers are solutions, as `refimpl.Solution.converged` has it."""

UNKNOWN_GRID = 256
"""Elements a side that runs without a given grid count as."""

Row = dict[str, Any]


@dataclass(frozen=True)
class Run:
    """One solve: ``coordinates`` for people, ``inputs`` for the machine.

    ``inputs`` is a JSON table: the whole scene, grid and solver settings, and digests of the code and of the
    measured files that it reads. So a changed program or file is another run.
    """

    coordinates: Mapping[str, float | int | None]
    inputs: Mapping[str, Any]

    @cached_property
    def canonical(self) -> str:
        """The inputs as JSON text, the same for equal inputs (floats by their shortest exact form)."""
        return json.dumps(self.inputs, sort_keys=True, separators=(",", ":"), allow_nan=False)

    @cached_property
    def key(self) -> str:
        """128 bits of the SHA-256 of the inputs, in hexadecimal."""
        return hashlib.sha256(self.canonical.encode()).hexdigest()[:32]

    @property
    def weight(self) -> float:
        """Expected work relative to other runs, for the time left: elements times their logarithm."""
        M = int(self.inputs["grid"] or UNKNOWN_GRID)
        return float(M * M * max(np.log2(M), 1.0))  # one element has no logarithm, but is work


@cache
def code_digest() -> str:
    """Return the digest of this installation's `refimpl` sources, and of the libraries' versions."""
    root = Path(rf.__file__).parent
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        digest.update(str(path.relative_to(root)).encode() + b"\0" + path.read_bytes() + b"\0")
    for name in LIBRARIES:
        with suppress(PackageNotFoundError):
            digest.update(f"{name} {version(name)}\0".encode())
    return digest.hexdigest()[:16]


def file_digest(path: Path) -> str:
    """Return the digest of a measured surface's file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16]


def execute(inputs: Mapping[str, Any]) -> Row:
    """Solve one run, anywhere, on one thread; the row of `OUTCOMES` and ``seconds``, of processor time.

    Raises RuntimeError where another version of the code is installed than the inputs name, and what
    `refimpl.solve` raises.
    """
    if inputs["code"] != code_digest():
        raise RuntimeError("this worker's refimpl differs from the one that planned the sweep")
    started = time.process_time()
    settings = inputs["solve"]
    with limited_to_one_thread():
        scene = scene_from_dict(inputs["scene"], Path())
        solution = rf.solve(scene, inputs["grid"], **settings)
    return outcome(solution, scene) | {"seconds": time.process_time() - started}


def outcome(solution: rf.Solution, scene: rf.Scene) -> Row:
    """Return the row of a solution of a scene."""
    contact, pair = solution.contact, solution.details.problem.pair
    index = None
    if pair.softer_hardness is not None:
        index = pair.reduced_modulus / pair.softer_hardness * roughness_slope(scene, solution.grid)
    return {
        "status": solution.status.value,
        **{name: getattr(solution, name) for name in QUANTITIES},
        **{f"{name}_error": solution.error(name) for name in QUANTITIES},
        **{
            f"{name}_cycle": solution.uncertainty.get(name, {}).get("active set", 0.0)
            for name in ("friction_coefficient", "contact_area")
        },
        "residual": solution.certificate.largest,
        "border_elements": int(contact.sum() - contact[1:-1, 1:-1].sum()),
        "plasticity_index": index,
        "elements_x": solution.grid.shape[0],
        "elements_y": solution.grid.shape[1],
        "warnings": "; ".join(
            dict.fromkeys(text.limit.value for text in solution.warnings if isinstance(text, ModelWarning))
        ),
    }
