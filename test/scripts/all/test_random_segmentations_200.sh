#!/bin/bash
# 200 random segmentations of another seed than those of test_random_segmentations.sh.
set -eu
RANDOM_SEGMENTATIONS=200 SEED=2 exec bash "$(dirname "$0")/../test_random_segmentations.sh"
