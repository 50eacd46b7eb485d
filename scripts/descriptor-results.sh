#!/usr/bin/env bash
# Measures the descriptors of solid space.
#   descriptor-results.sh retrieval    writes docs/results/retrieval-descriptors.md
#   descriptor-results.sh invariance   writes docs/results/descriptor-invariance.md and its pictures
#   SHAPE3D_DATA=<folder>  with psb/ (training half of the Princeton Shape Benchmark) and genus0/
#   SHAPE3D_BUILD=<folder> a build with SHAPE3D_BUILD_BENCHMARKS=ON (default build/bench)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
: "${SHAPE3D_DATA:?the folder with psb/ and genus0/}"
build=${SHAPE3D_BUILD:-build/bench}
[[ -f $build/CMakeCache.txt ]] || cmake --preset bench >/dev/null
mkdir -p docs/results docs/images
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
psb=$SHAPE3D_DATA/psb
machine="$(sed -n 's/^model name\s*: //p' /proc/cpuinfo | head -1), $(nproc) processors, load $(cut -d' ' -f1 /proc/loadavg) at the start"

retrieval() {
  cmake --build "$build" --target shape3d_retrieval >&2
  "$build/benchmarks/shape3d_retrieval" --classes "$psb/classification/v1/base/train.cla" \
    --models "$psb/db" --list benchmarks/descriptor_list.txt --output "$work/table"
  {
    cat <<'PAGE'
# Retrieval by descriptors of solid space

`scripts/descriptor-results.sh retrieval` writes this page from `benchmarks/descriptor_list.txt`.

Training half of the Princeton Shape Benchmark, its 90 base classes; every model searches for its class
among all the others. NN: the nearest is of the class. Tiers: share of the class among the |C| − 1 and
2(|C| − 1) nearest. E: of the first 32. DCG: discounted cumulative gain over that of a perfect ranking. All in
percent, means over the models; ties in the order of the classification. Parameters and distances were
chosen on these same models: another half is for judging them.

PAGE
    cat "$work/table" benchmarks/descriptor_remarks.md
    printf '\nMachine: %s.\n' "$machine"
  } >"$work/page.md"
  install -m 644 "$work/page.md" docs/results/retrieval-descriptors.md
  echo docs/results/retrieval-descriptors.md
}

invariance() {
  cmake --build "$build" --target shape3d_descriptor_invariance >&2
  local shapes=() tanks=() cars=() shape
  for shape in bunny_6k hand_16k human_man_14k scorpion_13k plane_17k goathead_5k; do
    shapes+=("$SHAPE3D_DATA/genus0/$shape.off")
  done
  for shape in 1411 1412 1413 1414 1415; do tanks+=("$psb/db/14/m$shape/m$shape.off"); done
  for shape in 1516 1518 1520 1522 1524; do cars+=("$psb/db/15/m$shape/m$shape.off"); done
  {
    cat <<'PAGE'
# How descriptors change with pose, mesh resolution and inner rotation

`scripts/descriptor-results.sh invariance` writes this page. A change is |x − y| / |x| of the vectors, in
percent; of D2, Σ |x − y|.

Each mesh in 20 random rotations. "Own first": of the unrotated meshes the nearest one is the mesh itself.
The dissertation's Tables 5.1 and 5.2 change by tens of percent from column to column.

![Change of vectors when an inner part turns](../images/internal-rotation.png)

Two parts on different radii, the inner turned about z by an angle (Fig. 5.4): concentric spheres have the
same vector for every angle; HSH and Gram matrices do not, because their radial functions see both parts.

![D2 histograms of tanks and cars](../images/d2-tanks-cars.png)

D2 of five tanks and five cars of the Princeton Shape Benchmark (Fig. 5.2): as gross shapes are alike, so are
their histograms.

Meshes of one name are compared with their finest. Not all show the same surface: those of the fish and spot_6k
come from other sources than the finest one, and their rows measure that difference; generated bodies are one
surface at each number of triangles.

PAGE
    "$build/benchmarks/shape3d_descriptor_invariance" --shapes "${shapes[@]}" --resolutions \
      "$SHAPE3D_DATA"/genus0/{bunny_6k,bunny_60k,spot_2k,spot_6k,spot_23k,fish_2k,fish_22k}.off \
      --tanks "${tanks[@]}" --cars "${cars[@]}" --rotation-picture docs/images/internal-rotation.png \
      --d2-picture docs/images/d2-tanks-cars.png
    printf '\nMachine: %s.\n' "$machine"
  } >"$work/page.md"
  install -m 644 "$work/page.md" docs/results/descriptor-invariance.md
  echo docs/results/descriptor-invariance.md
}

case ${1:-} in
  retrieval | invariance) "$1" ;;
  *)
    echo "descriptor-results.sh: expected retrieval or invariance, not '${1:-}'" >&2
    exit 2
    ;;
esac
