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
  "$shape3d" library add "$work/new.db" "$SHAPE3D_DATA/shrec11_500" --class-from-folder --descriptor hsh:K=8 --quiet
  mv "$work/new.db" "$work/shapes.db"
}

# smaller FROM TO: 256 colours, a third of the bytes.
smaller() { convert "$1" +dither -colors 256 -strip -define png:compression-level=9 "PNG8:$2"; }

# draw NAME STATE FILE...: the whole window with a view of the files. Views that this viewer does not have are left out.
draw() {
  local name=$1 state=$2 view=${1%%-*}
  shift 2
  local picture=$images/viewer-$name.png
  "$viewer" --offscreen --view "$view" --state "$state" --size 1280x720 -o "$work/$name.png" "$@"
  smaller "$work/$name.png" "$picture"
  echo "docs/images/viewer-$name.png: $(stat --format %s "$picture") bytes"
}

volume() {
  skull
  draw volume '{"window": {"level": 300, "width": 1600}, "cursor": [128, 92, 50]}' "$work/skull.mhd"
}

surface() {
  skull
  draw surface '{"surfaces": [
    {"isovalue": 226, "color": "#f1e6cf"},
    {"isovalue": -200, "color": "#db8468", "opacity": 0.3}], "marks": false}' "$work/skull.mhd"
}

segmentation() {
  draw segmentation "{\"truth\": \"$SHAPE3D_DATA/truth/cip_wholeLung-64_64x64x79_mask.mhd\", \"inside\": \"1\", \"run\": true}" \
    "$SHAPE3D_DATA/truth/cip_ct-64_64x64x79.mhd"
}

sphere() {
  draw sphere '{"color": "curvature"}' "$SHAPE3D_DATA/genus0/spot_23k.off"
}

search() {
  library
  draw search '{"query": 131, "count": 17}' "$work/shapes.db"
}

map() {
  library
  if [[ ! -f $work/map.model ]]; then
    "$shape3d" library export "$work/shapes.db" --h5 "$work/vectors.h5" --quiet
    "$shape3d" train som "$work/vectors.h5" --class-from-folder --grid 10x14 -o "$work/map.model" --quiet
  fi
  draw map '{"unit": [3, 4]}' "$work/map.model" "$work/shapes.db"
}

sheet() {
  "$shape3d" render --sheet "$SHAPE3D_DATA/genus0" --size 1280x1000 -o "$work/sheet.png"
  smaller "$work/sheet.png" "$images/contact-sheet.png"
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
