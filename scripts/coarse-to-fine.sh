#!/usr/bin/env bash
# Searches from coarse to fine on real meshes (section 4.4), and writes docs/results/coarse-to-fine.md.
#
# usage: SHAPE3D_DATA=<folder with psb/ and shrec11_500/> scripts/coarse-to-fine.sh
#
# With SHAPE3D_BENCH_FOLDER=<build folder> nothing is built. SHAPE3D_BENCH_WORK=<folder> keeps the tables of vectors, and
# uses those that are there. SHAPE3D_BENCH_RUNNER=<command> goes before each command that is timed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
: "${SHAPE3D_DATA:?expected a folder with psb/db and shrec11_500}"
build=${SHAPE3D_BENCH_FOLDER:-build/bench}
if [[ -z ${SHAPE3D_BENCH_FOLDER:-} ]]; then
  scripts/install-deps.sh
  cmake --preset bench
  cmake --build --preset bench --parallel "$(nproc)" --target shape3d shape3d_search_bench
fi
if [[ -n ${SHAPE3D_BENCH_WORK:-} ]]; then
  work=$SHAPE3D_BENCH_WORK
  mkdir -p "$work"
else
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
fi
scripts/coarse_to_fine.py "$build" "$SHAPE3D_DATA" "$work" >"$work/coarse-to-fine.md"
mkdir -p docs/results
cp "$work/coarse-to-fine.md" docs/results/coarse-to-fine.md
echo "docs/results/coarse-to-fine.md" >&2
