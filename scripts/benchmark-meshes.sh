#!/usr/bin/env bash
# Times pose, inspection, curvature and levels of detail, and writes docs/benchmarks/meshes.md.
#
# usage: scripts/benchmark-meshes.sh [MESH.off]...
#
# Each MESH.off of triangles gets a table of its own beside those of the generated body. With
# SHAPE3D_BENCH_FOLDER=<build folder> nothing is built. A quiet machine gives narrow quartiles.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit
here=${OLDPWD:?}
build=${SHAPE3D_BENCH_FOLDER:-build/bench}
if [[ -z ${SHAPE3D_BENCH_FOLDER:-} ]]; then
  scripts/install-deps.sh
  cmake --preset bench
  cmake --build --preset bench --parallel "$(nproc)" --target shape3d_mesh_bench
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
run() {
  local name=$1
  shift
  "$@" "$build/benchmarks/shape3d_mesh_bench" --benchmark_repetitions=3 \
    --benchmark_min_time=0.02 --benchmark_out="$work/$name.json" --benchmark_out_format=json >&2
}
run generated env -u SHAPE3D_BENCH_MESH
for mesh in "$@"; do
  [[ $mesh == /* ]] || mesh=$here/$mesh
  name=$(basename "$mesh" .off)
  run "$name" env SHAPE3D_BENCH_MESH="$mesh"
done
mkdir -p docs/benchmarks
scripts/benchmark-meshes.py "$work"/generated.json \
  $(find "$work" -name '*.json' ! -name generated.json | sort) >docs/benchmarks/meshes.md
echo "docs/benchmarks/meshes.md" >&2
