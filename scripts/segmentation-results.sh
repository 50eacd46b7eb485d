#!/usr/bin/env bash
# Segments phantoms and, where SHAPE3D_DATA names them, real volumes, and writes
# docs/results/segmentation.md with its pictures.
#   scripts/segmentation-results.sh [PART…]    phantom nodules stability real boxes methods itk; all without
# Parts that are not named keep the results of their last run (build/segmentation/*.json).
# ITK is compared with when libinsighttoolkit5-dev is installed; that part takes minutes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=build/segmentation-results
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DSHAPE3D_BUILD_BENCHMARKS=ON \
  -DSHAPE3D_BUILD_TESTS=OFF -DSHAPE3D_BUILD_EXAMPLES=OFF >/dev/null
targets=(shape3d shape3d_lung_phantom_volume shape3d_segmentation_stability)
if cmake --build "$build" --target help | grep -q shape3d_levelset_itk; then
  targets+=(shape3d_levelset_itk)
fi
cmake --build "$build" --target "${targets[@]}"
exec scripts/segmentation_results.py "$build" "$@"
