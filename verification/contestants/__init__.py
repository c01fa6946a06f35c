"""Former name of `verification.solver_suite`: its public modules, for one release."""

import sys
import warnings
from importlib import import_module

warnings.warn("verification.contestants is now verification.solver_suite", DeprecationWarning, stacklevel=2)
for _name in ("command", "own", "protocol", "reference", "suite"):
    _module = globals()[_name] = import_module(f"verification.solver_suite.{_name}")
    sys.modules[f"{__name__}.{_name}"] = _module
