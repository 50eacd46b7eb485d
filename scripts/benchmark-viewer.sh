#!/usr/bin/env bash
# Times opening, dragging and turning in the viewer, and its memory, and writes
# docs/benchmarks/viewer.md.
#
# usage: scripts/benchmark-viewer.sh
#
# With SHAPE3D_VIEWER=<program> nothing is built. The pictures are drawn by the processor (Mesa's
# llvmpipe) under Xvfb; a quiet machine matters.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
viewer=${SHAPE3D_VIEWER:-build/release/apps/viewer/shape3d-viewer}
if [[ -z ${SHAPE3D_VIEWER:-} ]]; then
  scripts/install-deps.sh
  cmake --preset release
  cmake --build --preset release --parallel "$(nproc)" --target shape3d_viewer
fi
table=$("$viewer" --benchmark)
model=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)
mkdir -p docs/benchmarks
cat >docs/benchmarks/viewer.md <<END
# The viewer: opening, dragging, turning, memory

Written by \`scripts/benchmark-viewer.sh\` (\`shape3d-viewer --benchmark\`), which runs everything again.

Processor: $model, $(nproc) threads, which also draw: there is no graphics card.
$table

- Opening begins with the samples in memory: least, greatest and automatic window of the values, three
  slices and the 3D view. Median of three. Volumes are generated (a gyroid with noise).
- Dragging: each picture is a ZMC surface of the volume at a lower resolution (at most 2¹⁸
  samples), its drawing, and its contours on three slices.
- Turning: mouse events, each with its picture on the screen; a surface of about 40,000 triangles, made
  by clustering vertices after the extraction, stands in for the full one. Medians.
- Memory is the resident size, 1.5 s after the surface was drawn. Before anything is open it is that of the libraries (Qt, VTK, and LLVM, which
  the software renderer compiles shaders with) and of the window. The renderer's own copy of the surface,
  which a graphics card would hold, counts as the program's, too.
  Runs end at one of two sizes, about 272 and 309 MiB (0.91 and 1.03 of the aim). They differ by 36 MiB, which is as much
  as a scene of llvmpipe may hold (LP_SCENE_MAX_SIZE): it seems to keep one scene or two, as the last frames were drawn.
END
echo "docs/benchmarks/viewer.md" >&2
