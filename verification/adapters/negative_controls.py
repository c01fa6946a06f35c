"""Negative controls: two codes set up as an unwary user may, which report success on a wrong state.

What they fail in the cross-code table is the suite's merit, not the peers' fault.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from verification.adapters import contactmechanics, tamaas

registered_only = replace(
    tamaas.solve,
    setup="registerNonPeriodic without setIntegralOperator: periodic where free space was meant",
    press=partial(tamaas.press, second_step=False),
)
"""Tamaas without the second step to free space."""

no_mean_stiffness = replace(
    contactmechanics.solve,
    setup="periodic half-space with stiffness_q0 = 0 under a load: stops at uniform pressure",
    press=partial(contactmechanics.press, mean_stiffness=0.0),
)
"""ContactMechanics with a mean pressure that displaces nothing, under a load."""
