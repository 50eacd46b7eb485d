#!/usr/bin/env bash
# Measures zmc against closed forms and against VTK's extractors, and its time and memory at the
# size of a clinical CT, and writes docs/results/accuracy.md.
#   SHAPE3D_DATA=<folder>  with classic/{engine_256x256x128,bonsai_256x256x256,tooth_103x94x161}.mhd
#                          and their .raw files: adds the rows of measured volumes
#   SHAPE3D_BUILD=<folder> a build with SHAPE3D_BUILD_BENCHMARKS=ON (default build/bench)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${SHAPE3D_BUILD:-build/bench}
[[ -f $build/CMakeCache.txt ]] || cmake --preset bench >/dev/null
cmake --build "$build" --target shape3d_zmc_accuracy shape3d_zmc_cost >&2

mkdir -p docs/results
result=docs/results/accuracy.md
work=$(mktemp "$result.XXXXXX")
trap 'rm -f "$work"' EXIT
vtk=$(dpkg-query --show --showformat='${source:Upstream-Version}' libvtk9-dev 2>/dev/null || echo 9)
{
  cat <<EOF
# Accuracy and topology of zmc beside VTK's extractors

\`scripts/accuracy.sh\` writes this page. VTK is $vtk.

## How to read the table

- **Volumes.** Planes, spheres and tori are integers, sampled on points of the lattice, of a
  polynomial whose zero set is the surface; in brackets how many samples are exactly zero. Random
  volumes are 48³ samples: zero with the given probability, otherwise −1 or 1. Engine, bonsai and
  tooth are scans of 8 bits.
- **Distances** to the closed form, in units of the lattice spacing: of the vertices, and of 36
  points on each triangle (the mean is by area). The field is not a distance but a polynomial of
  degree 2 (sphere) or 4 (torus), so that linear interpolation along an edge errs in proportion to
  the curvature: at twice the resolution the distances, in spacings, are half; in units of the
  object a quarter.
- **Merged first.** vtkFlyingEdges3D makes several points at one place where a sample is zero. Before
  anything is counted, points at exactly equal positions are merged, in every extractor's surface.
  *Repeated id*: triangles that then have two equal corners. *Zero area*: three different corners on
  a line. *Duplicates*: triangles whose three corners an earlier one has.
- **Odd edges**: edges inside the volume that belong to an odd number of triangles. χ is the Euler
  characteristic of the surface, and of that of the negated volume at the negated isovalue.
- **Neutral**: the negated volume gives the same triangles, orientation and those of repeated ids
  aside; otherwise how many are in one of the two surfaces only. A square cut along its other
  diagonal counts four; where χ differs the shape does.

## Result

EOF
  "$build/benchmarks/shape3d_zmc_accuracy" "$@"
  cat <<'EOF'

What the table says:

- On the planes, spheres and tori `compact` and VTK's extractors have equally many vertices at the
  same distances from the truth: taking zeros for what they are costs no accuracy and gains none
  there. `centroid` has more vertices; those in the middle of a polygon are as far from the truth as
  the polygon is.
- No surface here has an odd edge. VTK's are closed because a zero is taken for one of the two
  signs, which is what makes them differ under negation.
- `vtkFlyingEdges3D` keeps the triangles that shrink to a line or a point where samples are zero;
  `vtkMarchingCubes` drops them. On random and measured volumes both have pairs of triangles in one
  place.
- Only `zmc` gives the same surface for each volume here and its negative. On the smooth shapes VTK's
  surfaces of the two have the same χ and differ in how some polygons are cut; on random and
  measured volumes χ differs: what is joined in one is separate in the other.

## Time and memory

EOF
  echo "One extraction of a gyroid of period 64 with noise, $(sed -n 's/^model name\s*: //p' /proc/cpuinfo | head -1), one thread.
Seconds are of that machine."
  for real in double float; do
    echo
    echo '```'
    "$build/benchmarks/shape3d_zmc_cost" "$real"
    echo '```'
  done
} >"$work"
chmod 644 "$work"
mv "$work" "$result"
echo "$result"
