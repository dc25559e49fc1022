#!/bin/bash
# The figures of the documentation are those that docs/figures/draw.py draws.
# Runs beside other tests.
set -eu
exec "$(dirname "$0")/../../docs/figures/draw.py" --check
