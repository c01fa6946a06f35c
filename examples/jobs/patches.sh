#!/usr/bin/env bash
# Size distribution of the contact patches of two rough planes: a table of patches, and counts by area.
set -euo pipefail
rough-friction solve rough-planes --grid 64 --patches patches.csv --plot patches.png --json patches.json
python - <<'END'
import csv
from collections import Counter
from math import floor, log2

rows = list(csv.DictReader(open("patches.csv", encoding="utf-8")))
areas = [float(row["area [m^2]"]) for row in rows]
smallest = min(areas)
octaves = Counter(floor(log2(area / smallest) + 1e-9) for area in areas)
print(f"{len(areas)} patches, {sum(areas):.6g} m^2, largest {max(areas):.6g} m^2")
for octave, number in sorted(octaves.items()):
    print(f"{smallest * 2**octave * 1e12:10.1f} um^2 and more: {number}")
END
