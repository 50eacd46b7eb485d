#!/usr/bin/env bash
# Times shape libraries and searches, and writes docs/benchmarks/search.md.
#
# usage: SHAPE3D_DATA=<folder with psb/> scripts/benchmark-search.sh
#
# Makes 100 000 small meshes (0.5 GB) and vectors of a million shapes in a temporary folder, and
# takes about 15 minutes. With SHAPE3D_BENCH_FOLDER=<build folder> nothing is built. SHAPE3D_BENCH_WORK=<folder> keeps
# the libraries, and uses those that are there. SHAPE3D_BENCH_RUNNER=<command> goes before each
# command that is timed, SHAPE3D_BENCH_LONG_RUNNER=<command> before the two that take minutes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
: "${SHAPE3D_DATA:?expected a folder with psb/db}"
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
scripts/benchmark_search.py "$build" "$SHAPE3D_DATA/psb/db" "$work" >"$work/search.md"
mkdir -p docs/benchmarks
cp "$work/search.md" docs/benchmarks/search.md
echo "docs/benchmarks/search.md" >&2
