#!/usr/bin/env bash
# Chapter 4 of the dissertation from the data: spherical normal images classified by a
# self-organizing map. Writes docs/results/chapter-4.md and its pictures.
#
# usage: SHAPE3D_DATA=<folder> scripts/reproduce-chapter-4.sh
#
# The folder has shrec11_500/<class>/train/*.obj and genus0/*.off. SHAPE3D_BUILD=<folder> names the
# build to use, with SHAPE3D_BUILD_APPS and SHAPE3D_BUILD_BENCHMARKS (default build/bench).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit
data=${SHAPE3D_DATA:?names the folder of the data, with shrec11_500 and genus0}
build=${SHAPE3D_BUILD:-build/bench}
[[ -f $build/CMakeCache.txt ]] || cmake --preset bench >/dev/null
cmake --build "$build" --target shape3d shape3d_chapter_4 >&2
shape3d=$build/apps/shape3d/shape3d
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
results=docs/results
mkdir -p "$results"

# Fig. 4.6: the U-matrix, by the programs that anyone has. Folders named test are kept out.
mapfile -t meshes < <(find "$data/shrec11_500" -path '*/train/*.obj' | LC_ALL=C sort)
spec="sni:K=16,form=amplitudes,align=cpca"
"$shape3d" describe "${meshes[@]}" --descriptor "$spec" -o "$work/sni.csv" --keep-going --quiet
"$shape3d" train som "$work/sni.csv" --class-from-folder -o "$work/map.model" --quiet
"$shape3d" map-collection "$work/map.model" --picture "$results/chapter-4-som.png" --quiet

# Fig. 4.3: a mesh and its spherical normal image; Fig. 4.8 has the others.
"$shape3d" map "$data/genus0/bunny_6k.off" -o "$work/sphere.off" --align --quiet \
  --picture "$results/chapter-4-map.png"

detailed=()
for name in armadillo_29k boat_32k bunny_60k cat_16k fish_22k hand_16k plane_17k spot_23k; do
  [[ ! -f $data/genus0/$name.off ]] || detailed+=("$data/genus0/$name.off")
done
{
  cat <<'EOF'
# Chapter 4: spherical normal images and self-organizing maps

`scripts/reproduce-chapter-4.sh` writes this page. The dissertation classifies 214 models of its own
collection, which is not public, and judges by eye. Here it is the training part of SHREC'11 (watertight
meshes of 500 triangles, 30 classes of 16 poses of non-rigid bodies): each mesh is repaired where it has
to be, aligned by continuous principal component analysis (4.1), mapped to the sphere (4.2), its normal
(SNI), curvature (SCI) and geometry image (SGI) expanded to K = 16 (4.4), and a map of 12 by 6 units
trained (4.5).

*Amplitudes* are the dissertation's vector, (K + 2)(K + 1) = 306 numbers of two components, of the pose;
*norms* are invariant under rotation, K + 1 numbers. Distances are Euclidean; percentages.
*Purity*: share of the models that are of the class of most in their unit; with shuffled classes it says
what 72 units give by chance. Every model looks for its class among all the others.

EOF
  "$build/benchmarks/shape3d_chapter_4" "$data/shrec11_500" "${detailed[@]}"
  cat <<'EOF'
## Pictures

![U-matrix and classes](chapter-4-som.png)

Fig. 4.6 again: the U-matrix of the map of SNI amplitudes and the class of most models in each unit.

![bunny and its map](chapter-4-map.png)

Fig. 4.3 again: a mesh and its map, normals as colours, and the change of angles.
EOF
} >"$work/page.md"
cp "$work/page.md" "$results/chapter-4.md"
echo "$results/chapter-4.md"
