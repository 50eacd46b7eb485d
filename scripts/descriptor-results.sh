#!/usr/bin/env bash
# Measures the descriptors of solid space and writes docs/results/retrieval-descriptors.md and
# docs/results/descriptor-invariance.md.
#   SHAPE3D_DATA=<folder>  with psb/ (training half of the Princeton Shape Benchmark) and genus0/
#   SHAPE3D_BUILD=<folder> a build with SHAPE3D_BUILD_BENCHMARKS=ON (default build/bench)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
: "${SHAPE3D_DATA:?the folder with psb/ and genus0/}"
build=${SHAPE3D_BUILD:-build/bench}
[[ -f $build/CMakeCache.txt ]] || cmake --preset bench >/dev/null
cmake --build "$build" --target shape3d_retrieval shape3d_descriptor_invariance >&2

mkdir -p docs/results
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
machine="$(sed -n 's/^model name\s*: //p' /proc/cpuinfo | head -1), $(nproc) processors"

"$build/benchmarks/shape3d_retrieval" \
  --classes "$SHAPE3D_DATA/psb/classification/v1/base/train.cla" --models "$SHAPE3D_DATA/psb/db" \
  --list benchmarks/descriptor_list.txt --output "$work/table"
{
  cat <<'PAGE'
# Retrieval by descriptors of solid space

`scripts/descriptor-results.sh` writes this page from `benchmarks/descriptor_list.txt`.

Training half of the Princeton Shape Benchmark, its 90 base classes; every model searches for its class
among all the others. NN: the nearest is of the class. Tiers: share of the class among the |C| − 1 and
2(|C| − 1) nearest. E: of the first 32. DCG: discounted cumulative gain over that of a perfect ranking. All in
percent, means over the models; ties in the order of the classification. Parameters were chosen on these
same models; another half is for judging them. Seconds are for all models, read already.

PAGE
  cat "$work/table"
  cat benchmarks/descriptor_remarks.md
  printf '\nMachine: %s.\n' "$machine"
} >"$work/retrieval.md"

shapes=()
for shape in bunny_6k armadillo_29k hand_16k human_man_14k scorpion_13k plane_17k cat_16k fish_22k \
  goathead_5k koala_7k penguin_7k; do
  shapes+=("$SHAPE3D_DATA/genus0/$shape.off")
done
{
  cat <<'PAGE'
# How descriptors change with pose, mesh resolution and inner rotation

`scripts/descriptor-results.sh` writes this page. A change is |x − y| / |x| of the vectors, in percent.

20 random rotations of each of 11 meshes. "Own first": of the unrotated meshes the nearest one is the
mesh itself.

PAGE
  "$build/benchmarks/shape3d_descriptor_invariance" --shapes "${shapes[@]}" --resolutions \
    "$SHAPE3D_DATA"/genus0/{bunny_6k,bunny_60k,spot_2k,spot_6k,spot_23k,fish_2k,fish_22k}.off
  printf '\nMachine: %s.\n' "$machine"
} >"$work/invariance.md"
install -m 644 "$work/retrieval.md" docs/results/retrieval-descriptors.md
install -m 644 "$work/invariance.md" docs/results/descriptor-invariance.md
echo docs/results/retrieval-descriptors.md docs/results/descriptor-invariance.md
