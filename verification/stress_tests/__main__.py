"""``python -m verification.stress_tests --json FILE``: run the study (four minutes on one thread)."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from verification.framework.threads import THREADS


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the study; status 1 where a state is neither right nor of a kind, or a contact is not lawful."""
    parser = argparse.ArgumentParser(prog="python -m verification.stress_tests", description=__doc__)
    parser.add_argument("--json", type=Path, required=True, help="file to write")
    parser.add_argument("--axis", action="append", default=[], help="only this axis; may be repeated")
    options = parser.parse_args(arguments)
    os.environ.update(dict.fromkeys(THREADS, "1"))

    from verification.output.files import Progress
    from verification.output.result_files import write_result
    from verification.stress_tests import study
    from verification.stress_tests.axes import AXES, states

    unknown = [name for name in options.axis if name not in AXES]
    if unknown:
        parser.error(f"--axis {unknown[0]!r}: expected one of {', '.join(AXES)}")
    with Progress(sum(1 for name in options.axis or AXES for _ in states(name))) as progress:
        found = study.document(study.run(options.axis, progress.tick))
    write_result(found, options.json)
    print(", ".join(f"{number} {verdict}" for verdict, number in found["counts"].items()), file=sys.stdout)
    wrong = sum(count["wrong"] for count in found["lawful states"])
    return 1 if study.unexplained(found["states"]) or wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
