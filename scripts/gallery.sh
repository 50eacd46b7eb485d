#!/usr/bin/env bash
# Draws the pictures of docs/gallery.md: each view of shape3d-viewer on real data.
#   scripts/gallery.sh [VIEW...]   volume, surface, segmentation, sphere, search, map, sheet; all when none is given
#   SHAPE3D_DATA=<folder>   with genus0/, truth/ and shrec11_500/; the CT is of Debian's invesalius-examples
#   SHAPE3D_BUILD=<folder>  a build with the programs (default build/release)
#   SHAPE3D_WORK=<folder>   keeps the volumes, the library and the map for the next time (default build/gallery)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
: "${SHAPE3D_DATA:?the folder with genus0/, truth/ and shrec11_500/}"
build=$(realpath "${SHAPE3D_BUILD:-build/release}")
work=$(realpath --canonicalize-missing "${SHAPE3D_WORK:-build/gallery}")
images=$PWD/docs/images
shape3d=$build/apps/shape3d/shape3d viewer=$build/apps/viewer/shape3d-viewer
for program in "$shape3d" "$viewer"; do
  [[ -x $program ]] || { echo "$program is not there: build the targets shape3d and shape3d_viewer" >&2; exit 1; }
done
mkdir -p "$work" "$images"

skull() {
  [[ -f $work/skull.mhd ]] || scripts/unpack-skull.py "$(scripts/skull-data.sh)" "$work" >/dev/null
}

library() {
  [[ -f $work/shapes.db ]] && return
  rm -f "$work/new.db"
  "$shape3d" library add "$work/new.db" "$SHAPE3D_DATA/shrec11_500" --class-from-folder --descriptor hsh:K=8,unit=yes --quiet
  mv "$work/new.db" "$work/shapes.db"
}

# smaller FROM TO: as it is up to 300 kB, else with 256 colours.
smaller() {
  convert "$1" -strip -define png:compression-level=9 "$2"
  [[ $(stat --format %s "$2") -le 300000 ]] ||
    convert "$1" -dither FloydSteinberg -colors 256 -strip -define png:compression-level=9 "PNG8:$2"
}

# draw NAME STATE FILE...: the whole window with a view of the files. Views that this viewer does not have are left out.
draw() {
  local name=$1 state=$2 view=${1%%-*}
  shift 2
  local picture=$images/viewer-$name.png
  "$viewer" --offscreen --view "$view" --state "$state" --size 1280x720 -o "$work/$name.png" "$@"
  smaller "$work/$name.png" "$picture"
  echo "docs/images/viewer-$name.png: $(stat --format %s "$picture") bytes"
}

# Near the head, from the patient's front and left.
head='"layout": {"camera": [374, -518, 193, 124, -112, 82, 0, 0, 1, 30]}'

volume() {
  skull
  draw volume '{"window": "bone", "cursor": [128, 92, 50], '"$head}" "$work/skull.mhd"
}

surface() {
  skull
  draw surface '{"surfaces": [
    {"isovalue": 226, "color": "#f1e6cf"},
    {"isovalue": -200, "color": "#e0906f", "opacity": 0.25}], "marks": false, '"$head}" "$work/skull.mhd"
}

segmentation() {
  local truth=$SHAPE3D_DATA/truth/cip_wholeLung-64_64x64x79_mask.mhd
  draw segmentation '{"truth": "'"$truth"'", "roi": [2, 33, 6, 56, 4, 78], "inside": "dark", "classes": "3",
    "cursor": [17, 29, 40], "start": "ball", "radius": 30, "run": true,
    "layout": {"camera": [-300, -325, 310, 75, 125, 160, 0, 0, 1, 30]}}' \
    "$SHAPE3D_DATA/truth/cip_ct-64_64x64x79.mhd"
}

sphere() {
  draw sphere '{"color": "curvature", "layout": {"camera": [-3.1, 1.9, -4.8, 0, 0.12, 0.2, 0, 1, 0, 30]}}' \
    "$SHAPE3D_DATA/genus0/spot_23k.off"
}

search() {
  library
  draw search '{"query": 403, "count": 17}' "$work/shapes.db"
}

map() {
  library
  if [[ ! -f $work/map.model ]]; then
    "$shape3d" library export "$work/shapes.db" --h5 "$work/vectors.h5" --quiet
    "$shape3d" train som "$work/vectors.h5" --class-from-folder --grid 8x8 -o "$work/map.model" --quiet
  fi
  draw map '{"unit": [8, 5]}' "$work/map.model" "$work/shapes.db"
}

sheet() { # one mesh of each shape
  local mesh
  rm -rf "$work/meshes"
  mkdir "$work/meshes"
  for mesh in armadillo_29k brain_choi_97k brain_gu_5k bunny_60k cat_16k fish_22k goathead_5k hand_16k \
    human_woman_14k koala_7k lion_choi_100k penguin_7k plane_17k scorpion_13k spot_23k; do
    ln -sf "$(realpath "$SHAPE3D_DATA/genus0/$mesh.off")" "$work/meshes/"
  done
  "$shape3d" render --sheet "$work/meshes" --size 1280x800 -o "$work/sheet.png" >/dev/null
  smaller "$work/sheet.png" "$images/contact-sheet.png"
  echo "docs/images/contact-sheet.png: $(stat --format %s "$images/contact-sheet.png") bytes"
}

has_view() { # NAME: the sentence for a wrong name lists the views
  { "$viewer" --offscreen --view none -o "$work/none.png" 2>&1 || true; } | grep -qw "$1"
}

for name in "${@:-volume surface segmentation sphere search map sheet}"; do
  for picture in $name; do
    case $picture in
    volume | surface | segmentation | sphere | search | map)
      if has_view "$picture"; then "$picture"; else echo "this viewer has no view $picture: left out" >&2; fi
      ;;
    sheet) sheet ;;
    *) echo "$picture: expected volume, surface, segmentation, sphere, search, map or sheet" >&2; exit 2 ;;
    esac
  done
done
