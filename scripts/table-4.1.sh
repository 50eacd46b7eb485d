#!/usr/bin/env bash
# Computes Table 4.1 of the dissertation again (feature vectors of a ball, a cube and a bunny) with
# `shape3d describe`, and writes docs/results/table-4.1.md.
#
# usage: SHAPE3D_DATA=<folder> scripts/table-4.1.sh
#
# The bunny is genus0/bunny_6k.off of that folder, or the mesh that the variable BUNNY names; without
# either the table has the ball and the cube alone. SHAPE3D_BUILD=<folder> names the build to use
# (default build/release).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit
build=${SHAPE3D_BUILD:-build/release}
if [[ -z ${SHAPE3D_BUILD:-} ]]; then
  scripts/install-deps.sh
  cmake --preset release
  cmake --build --preset release --parallel "$(nproc)" --target shape3d
fi
bunny=${BUNNY:-${SHAPE3D_DATA:+$SHAPE3D_DATA/genus0/bunny_6k.off}}
mkdir -p docs/results
/usr/bin/python3 scripts/table_4_1.py "$build/apps/shape3d/shape3d" "$bunny" > docs/results/table-4.1.md.new
mv docs/results/table-4.1.md.new docs/results/table-4.1.md
