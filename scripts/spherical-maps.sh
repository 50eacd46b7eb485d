#!/usr/bin/env bash
# Maps meshes to the sphere, beside conformalised mean curvature flow, and writes
# docs/results/spherical-maps.md.
#   SHAPE3D_DATA=<folder>  with genus0/*.off: adds the rows of these meshes
#   SHAPE3D_BUILD=<folder> a build with SHAPE3D_BUILD_BENCHMARKS=ON (default build/bench)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${SHAPE3D_BUILD:-build/bench}
[[ -f $build/CMakeCache.txt ]] || cmake --preset bench >/dev/null
cmake --build "$build" --target shape3d_spherical_maps >&2

load=$(cut -d' ' -f1 /proc/loadavg)
mkdir -p docs/results
result=docs/results/spherical-maps.md
work=$(mktemp "$result.XXXXXX")
trap 'rm -f "$work"' EXIT
meshes=()
[[ ! -d ${SHAPE3D_DATA:-}/genus0 ]] || meshes=("$SHAPE3D_DATA/genus0")
{
  cat <<'EOF'
# Spherical maps

`scripts/spherical-maps.sh` writes this page.

## How to read the tables

- **Status.** Certified: no triangle is flipped or degenerate and the degree is 1, by exact
  predicates. Anything else comes without a map.
- **Mean, p95, max**: |angle on the sphere − angle in the mesh| in degrees, over all corners, with
  plane triangles on both sides. **σ**: σ1/σ2 of the map of a triangle. **> 10**: triangles whose σ1/σ2
  is above 10; *of these slivers*: with an angle under 5° in the mesh. **E/A**: Dirichlet energy over
  the area of the image. **Starved**: share of the surface that gets under 1 % of its fair part of the
  sphere, as every conformal map of such a shape would have it.
- **Flow**: conformalised mean curvature flow (Kazhdan, Solomon, Ben-Chen 2012), 100 steps of 0.01 for a
  surface of area 1, lumped masses; the last surface projected to the sphere about its centroid.
  *Flipped* counts flipped and degenerate triangles; *roundness* is the deviation of the radii over
  their mean before projection: large where the flow is far from a sphere.
- **Cost**: Ceres' ½ Σ |r|², half the mean excess of σ1/σ2 + σ2/σ1 over 2 (docs/notes/mapping.md, 6);
  *before* is that of the linear map, *after* before the refinement of the angles. USER_SUCCESS: a full
  step gained less than the tolerance. **All s**: with the refinement.
- Generated bodies: capsules by the length of the cylinder over its radius, 32 vertices round;
  star-shaped bodies of log-radius in random spherical harmonics to degree 8; bodies whose coordinates
  are expansions to degree 6, some of which cut through themselves.

EOF
  "$build/benchmarks/shape3d_spherical_maps" "$@" "${meshes[@]}"
  echo
  echo "Seconds: one run, one thread, $(sed -n 's/^model name\s*: //p' /proc/cpuinfo | head -1), load ${load} at the start.
Flows run two at a time.
Peak memory is that of a process that makes or reads the mesh and maps it twice."
} >"$work"
chmod 644 "$work"
mv "$work" "$result"
echo "$result"
