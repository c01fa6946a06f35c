#!/usr/bin/env bash
# A ball on a measured flat: how rough the flat is, and friction to 1 %. Reads measured.toml and specimen.txt.
set -euo pipefail
rough-friction inspect specimen.txt --plot specimen.png
rough-friction solve measured.toml --accuracy 0.01 --max-grid 256 --plot measured.png --json measured.json
