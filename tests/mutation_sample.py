"""``python tests/mutation_sample.py SESSION N SEED``: keep a random sample of the mutants of cosmic-ray."""

from __future__ import annotations

import random
import sqlite3
import sys


def main(session: str, count: int, seed: int) -> None:
    """Delete all but ``count`` mutants that are still to be tried, drawn with ``seed``."""
    with sqlite3.connect(session) as database:
        found = database.execute(
            "SELECT job_id FROM mutation_specs WHERE job_id NOT IN (SELECT job_id FROM work_results) "
            "ORDER BY module_path, operator_name, occurrence"
        ).fetchall()
        kept = set(random.Random(seed).sample(found, min(count, len(found))))
        for table in ("mutation_specs", "work_items", "work_results"):
            rows = database.execute(f"SELECT job_id FROM {table}").fetchall()
            database.executemany(
                f"DELETE FROM {table} WHERE job_id = ?", [row for row in rows if row not in kept]
            )


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
