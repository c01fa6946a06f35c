#!/usr/bin/env bash
# Friction over load, a curve for each roughness, with the scatter of realisations. Interrupted by Ctrl-C, the same script
# goes on where it was. Reads loads.toml.
set -euo pipefail
rough-friction sweep loads.toml --workers 2 --csv loads.csv --plot loads.svg --x load --by lower_rms --json loads.json
