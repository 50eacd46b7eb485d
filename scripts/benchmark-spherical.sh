#!/usr/bin/env bash
# Measures spherical images and their harmonics and writes docs/benchmarks/spherical-harmonics.md.
#
# usage: scripts/benchmark-spherical.sh
#
# SHAPE3D_BUILD=<folder> names the build to use (default build/bench).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit
build=${SHAPE3D_BUILD:-build/bench}
if [[ -z ${SHAPE3D_BUILD:-} ]]; then
  scripts/install-deps.sh
  cmake --preset bench
  cmake --build --preset bench --parallel "$(nproc)" --target shape3d_spherical_bench
fi
json=$(mktemp)
trap 'rm -f "$json"' EXIT
"$build/benchmarks/shape3d_spherical_bench" --benchmark_repetitions=5 --benchmark_min_time=0.02 \
  --benchmark_enable_random_interleaving=true --benchmark_out="$json" --benchmark_out_format=json >/dev/null
/usr/bin/python3 scripts/benchmark_spherical.py "$json" > docs/benchmarks/spherical-harmonics.md.new
mv docs/benchmarks/spherical-harmonics.md.new docs/benchmarks/spherical-harmonics.md
