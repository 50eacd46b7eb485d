#!/usr/bin/env bash
# Draws the pictures of cells in docs/images.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${SHAPE3D_BUILD:-build/release}
[[ -f $build/CMakeCache.txt ]] || cmake --preset release >/dev/null
cmake --build "$build" --target shape3d_figures
mkdir -p docs/images
"$build/apps/figures/shape3d_figures" docs/images
