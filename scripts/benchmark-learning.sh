#!/usr/bin/env bash
# Times maps and machines, beside svm-train of libsvm, and writes docs/benchmarks/learning.md.
#   SHAPE3D_BUILD=<folder> a build with SHAPE3D_BUILD_BENCHMARKS=ON (default build/bench)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${SHAPE3D_BUILD:-build/bench}
[[ -f $build/CMakeCache.txt ]] || cmake --preset bench >/dev/null
cmake --build "$build" --target shape3d_learning_bench shape3d_svm_grid >&2

mkdir -p docs/benchmarks
result=docs/benchmarks/learning.md
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$build/benchmarks/shape3d_learning_bench" --benchmark_min_time=0.1 --benchmark_repetitions=3 \
  --benchmark_report_aggregates_only=true --benchmark_out="$work/times.json" \
  --benchmark_out_format=json "$@" >&2
/usr/bin/python3 scripts/benchmark_learning.py "$work" "$build/benchmarks/shape3d_svm_grid" >"$work/page.md"
install -m 644 "$work/page.md" "$result"
echo "$result"
