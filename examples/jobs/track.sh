#!/usr/bin/env bash
# Friction of two measured maps against the sliding distance. Reads track.toml, pair.toml, slider.npy and track.npy.
set -euo pipefail
rough-friction sweep track.toml --workers 2 --csv track.csv --plot track.pdf --x sliding_offset --json track.json
