#!/usr/bin/env bash
# How much of the contact yields, and what that does to friction. Reads yield.toml and ball.toml.
set -euo pipefail
rough-friction sweep yield.toml --workers 2 --csv yield.csv --json yield.json \
  --plot yield.svg --x load --y plastic_share --by lower.material.hardness
rough-friction solve ball.toml --grid 64 --plot ball.png --json ball.json
rough-friction solve ball.toml --grid 64 --plastic off --json elastic.json
