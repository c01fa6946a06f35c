"""The written form of a measurement: the table, the scene and the conditions it was taken under."""

from __future__ import annotations

import os
from collections.abc import Sequence
from importlib.metadata import version

from refimpl import scene_to_toml
from verification.framework.case import jsonable
from verification.framework.provenance import provenance
from verification.variational.energy import table2_scene
from verification.variational.minimisers import GRADIENT_TOLERANCE, INTERIOR_TOLERANCE, MINIMISERS
from verification.variational.timing import (
    AT_APPROACH,
    PAPER_GRIDS,
    SMALLER_GRIDS,
    UNDER_LOAD,
    measure,
    table,
)


def document(rounds: int, budget: float, grids: Sequence[int] | None = None) -> object:
    """Measure everything on the paper's grids, or on those given, and say how; ready for JSON."""
    load_before = os.getloadavg()
    methods = (*UNDER_LOAD, *AT_APPROACH, *MINIMISERS)
    rows = measure(grids or SMALLER_GRIDS + PAPER_GRIDS, methods, rounds, budget)
    conditions = {
        "clock": "cpu: time.process_time of one process with one thread; wall: time.perf_counter",
        "machine": "shared with other work while this ran: compare processor times, within one grid",
        "load average": {"before": load_before, "after": os.getloadavg()},
        "order": "the methods take turns on every grid; the least of the rounds counts; over 20 s: one round",
        "rounds": rounds,
        "budget (s)": budget,
        "kernel tables": "computed once beforehand and shared by all methods",
        "tolerances": {
            "paper": "its own, 1e-4 of the load and 1e-5 of the pressure",
            "production": "certificate of 1e-8",
            "NNLS": "active sets: to rounding",
            "L-BFGS-B": f"projected gradient {GRADIENT_TOLERANCE:g} of the approach",
            "PIQP": f"residuals {INTERIOR_TOLERANCE:g} of the approach",
        },
        "initial points": "kinematic interference at the approach that carries the load",
    }
    head = {
        "scene": scene_to_toml(table2_scene()),
        "slopes": "neglected (cosines 1), so that all methods minimise the same energy",
        "conditions": conditions,
        "provenance": provenance() | {"piqp": version("piqp")},
    }
    return jsonable(head | table(rows))
