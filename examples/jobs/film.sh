#!/usr/bin/env bash
# A prediction to compare with an experiment of 1990: mu of a ball on a film of MoS2 goes with the load to the power -0.32.
# Reads film.toml and film-loads.toml.
set -euo pipefail
rough-friction sweep film-loads.toml --csv film.csv --plot film.svg --x load
