#!/usr/bin/env bash
# Installs what is missing, builds the program, extracts the bone and the skin of a real CT and
# segments its bone; then makes a library of meshes that Debian distributes, and searches it.
#   scripts/demo.sh [FOLDER]     the folder receives meshes, pictures and reports; build/demo if none is given
# SHAPE3D_UPDATE_IMAGES=1 also renews the picture of the README.
set -euo pipefail
out=$(realpath --canonicalize-missing "${1:-$(dirname "${BASH_SOURCE[0]}")/../build/demo}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf '\n== %s\n' "$*"; }

scripts/install-deps.sh
if command -v ccache >/dev/null; then
  export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
say "building"
cmake --preset release >/dev/null
cmake --build --preset release --parallel "$(nproc)" --target shape3d
shape3d=$PWD/build/release/apps/shape3d/shape3d
started=$SECONDS

archive=$(scripts/skull-data.sh)
scripts/unpack-skull.py "$archive" "$out"
meshes=$(scripts/demo-meshes.sh)
read -r bone skin < <(/usr/bin/python3 -c '
import json, sys
print(*(part["threshold"] for part in json.load(open(sys.argv[1]))["parts"]))' "$out/skull.json")
cd "$out"

say "the CT"
"$shape3d" info skull.mhd

say "bone ($bone) and skin ($skin), closed at the border of the volume"
"$shape3d" extract skull.mhd --iso "$bone" --iso "$skin" --cap -o skull.ply --json surfaces.json
mv "skull_$bone.ply" bone.ply
mv "skull_$skin.ply" skin.ply
/usr/bin/python3 - <<'PYTHON'
import json
surfaces = json.load(open("surfaces.json"))["surfaces"]
for surface, part in zip(surfaces, json.load(open("skull.json"))["parts"]):
    print(f"\nvolume at {part['threshold']}: {surface['volume']:,.1f} mm3; "
          f"of the surface that comes with the CT: {part['volume']:,.1f} mm3", end="")
print()
PYTHON

say "the same beside VTK's extractors, not capped"
"$shape3d" compare skull.mhd --iso "$bone" --json compare.json

say "the contour in the middle slice"
"$shape3d" contours skull.mhd --iso "$bone" --axis z --slice 54 -o slice.svg

say "the bone found by its intensities and gradients, without an isovalue"
# In the box of the head: in the whole volume the skin is the stronger edge.
"$shape3d" segment skull.mhd --roi 40,216,24,246,0,108 --classes 5 --inside 4 -o bone.nii.gz \
  --mesh segmented.ply --contours z=54 segmented.svg --plot segmentation --json segment.json

say "pictures"
"$shape3d" render bone.ply --largest -o skull.png --size 800x800
"$shape3d" render segmented.ply --largest -o segmented.png --size 800x800
"$shape3d" render bone.ply skin.ply --largest --color bone --color skin --opacity 1 --opacity 0.3 \
  --view oblique -o head.png --size 800x800
if [[ ${SHAPE3D_UPDATE_IMAGES:-0} == 1 ]]; then
  "$shape3d" render bone.ply --largest -o "$OLDPWD/docs/images/skull.png" --size 420x420
fi

say "a library of meshes of the package libcgal-demo, by class"
rm -rf shapes shapes.db
mkdir shapes
tar --extract --gzip --file "$meshes" --directory shapes
put() { # CLASS NAME...: into the folder of the class
  local class=$1 name
  shift
  mkdir -p "shapes/classes/$class"
  for name in "$@"; do mv "shapes/data/meshes/$name.off" "shapes/classes/$class/"; done
}
put animal armadillo bear bear_bis bull camel cow diplodocus dino elephant elk lion-head pig triceratops
put head head mannequin-devil nefertiti
put human homer man
put mechanical anchor anchor_dense couplingdown fandisk handle joint part pinion rotor spool turbine
put round blobby ellipsoid geosphere oblong sphere sphere966 larger_sphere
put knot eight knot1 knot2 knot double-torus-example
put box cube cube-meshed small_cube translated-cube beam cheese-box
"$shape3d" library add shapes.db shapes/classes --class-from-folder --descriptor hsh:K=8,unit=yes \
  --descriptor d2 --json library.json
"$shape3d" search shapes.db shapes/classes/animal/elephant.off --sheet search.png --json search.json
"$shape3d" distance shapes/classes/animal/bear.off shapes/classes/animal/bear_bis.off --align

say "done in $((SECONDS - started)) s after the build"
echo "The pictures are $out/skull.png, $out/head.png, $out/segmented.png, $out/slice.svg and those in $out/segmentation;"
echo "the meshes bone.ply, skin.ply and segmented.ply and the label map bone.nii.gz are beside them."
echo "$out/search.png shows what the library shapes.db has that is like an elephant."
