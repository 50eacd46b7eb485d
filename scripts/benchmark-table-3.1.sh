#!/usr/bin/env bash
# Runs Table 3.1 of the dissertation again beside VTK and scikit-image, and writes
# docs/benchmarks/table-3.1.md with its plot.
#
# usage: scripts/benchmark-table-3.1.sh [OPTION | PATH[@ISOVALUE]]...
#
# PATH is a volume, or a folder of MetaImages and DICOM series. SHAPE3D_DATA=<folder> adds those of
# that folder. Options are those of shape3d_table_3_1 (--help). scikit-image is compared when it is
# installed (Debian package python3-skimage). A quiet machine gives narrow quartiles.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit
here=${OLDPWD:?}

arguments=()
for argument in "$@"; do
  # Relative paths are those of the caller.
  if [[ $argument != -* && $argument != /* && -e $here/${argument%@*} ]]; then
    argument=$here/$argument
  fi
  arguments+=("$argument")
done
if [[ -n ${SHAPE3D_DATA:-} ]]; then
  if [[ $SHAPE3D_DATA != /* ]]; then SHAPE3D_DATA=$here/$SHAPE3D_DATA; fi
  if [[ ! -d $SHAPE3D_DATA ]]; then
    echo "error: SHAPE3D_DATA is '$SHAPE3D_DATA'; expected a folder" >&2
    exit 2
  fi
  export SHAPE3D_DATA
fi

scripts/install-deps.sh
if command -v ccache >/dev/null; then
  export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
cmake --preset bench
cmake --build --preset bench --parallel "$(nproc)" --target shape3d_table_3_1
mkdir -p docs/benchmarks
build/bench/benchmarks/shape3d_table_3_1 --output docs/benchmarks/table-3.1.md "${arguments[@]}"
