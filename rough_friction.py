"""Front door of the console script: names what hides the packages of this project."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path


def run(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; status 2 and one line where a module of the user has the name of its package."""
    found = find_spec("verification")  # a package that is found is not yet imported
    places = list(found.submodule_search_locations or ()) if found else []
    if not any(Path(place, "start.py").is_file() for place in places):
        there = found.origin if found and found.origin else ", ".join(places) or "nothing"
        sys.stderr.write(
            f"rough-friction: {there} hides this program's package 'verification': rename it, "
            "or run elsewhere and without its folder in PYTHONPATH\n"
        )
        return 2
    from verification.start import run as start

    return start(arguments)


if __name__ == "__main__":
    raise SystemExit(run())
