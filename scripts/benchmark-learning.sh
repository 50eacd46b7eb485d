#!/usr/bin/env bash
# Times maps and machines, beside svm-train of libsvm, and writes docs/benchmarks/learning.md.
#   benchmark-learning.sh [times | grid 1 | grid 2 | page]...   only these steps (default: all); what they
#   measure is kept in the build folder
#   SHAPE3D_BUILD=<folder> a build with SHAPE3D_BUILD_BENCHMARKS=ON (default build/bench)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${SHAPE3D_BUILD:-build/bench}
[[ -f $build/CMakeCache.txt ]] || cmake --preset bench >/dev/null
cmake --build "$build" --target shape3d_learning_bench shape3d_svm_grid >&2
work=$build/learning-times
mkdir -p "$work" docs/benchmarks

[[ $# -gt 0 ]] || set -- times grid 1 grid 2 page
while [[ $# -gt 0 ]]; do
  case $1 in
  times)
    "$build/benchmarks/shape3d_learning_bench" --benchmark_min_time=0.1 --benchmark_repetitions=3 \
      --benchmark_report_aggregates_only=true --benchmark_out="$work/times.json" \
      --benchmark_out_format=json >&2
    ;;
  grid)
    /usr/bin/python3 scripts/benchmark_learning.py grid "$work" "$build/benchmarks/shape3d_svm_grid" "$2"
    shift
    ;;
  page)
    /usr/bin/python3 scripts/benchmark_learning.py page "$work" >"$work/page.md"
    install -m 644 "$work/page.md" docs/benchmarks/learning.md
    echo docs/benchmarks/learning.md
    ;;
  *)
    echo "benchmark-learning: unknown step '$1', expected times, grid or page" >&2
    exit 2
    ;;
  esac
  shift
done
