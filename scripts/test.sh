#!/usr/bin/env bash
# Installs what is missing, builds everything with warnings as errors and runs all tests.
# SHAPE3D_DATA=<folder> adds the tests on large data sets, which are not part of the sources.
set -euo pipefail
if [[ -n ${SHAPE3D_DATA:-} ]]; then
  if [[ ! -d $SHAPE3D_DATA ]]; then
    echo "error: SHAPE3D_DATA is '$SHAPE3D_DATA'; expected a folder" >&2
    exit 2
  fi
  SHAPE3D_DATA=$(realpath "$SHAPE3D_DATA")
  export SHAPE3D_DATA
fi
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install-deps.sh
if command -v ccache >/dev/null; then
  export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
jobs=$(nproc)
cmake --preset release -DSHAPE3D_WARNINGS_AS_ERRORS=ON
cmake --build --preset release --parallel "$jobs"
ctest --preset release --parallel "$jobs"
