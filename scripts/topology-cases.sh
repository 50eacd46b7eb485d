#!/usr/bin/env bash
# Maps meshes that are no closed surfaces of genus 0: what they are refused for, and whether --repair
# and --wrap help. Writes docs/results/topology-cases.md.
#
# usage: scripts/topology-cases.sh PROGRAM MESH...
#
# PROGRAM is the built shape3d.
set -euo pipefail
program=$(realpath "$1")
shift
meshes=()
for mesh in "$@"; do meshes+=("$(realpath "$mesh")"); done
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Prints "triangles, mean angle change" of a map, or the last clause of the refusal.
attempt() {
  local mesh=$1
  shift
  if "$program" map "$mesh" -o "$work/s.off" --mesh "$work/m.off" --json "$work/r.json" -q "$@" \
    2>"$work/err"; then
    /usr/bin/python3 - "$work/r.json" "$work/m.off" <<'PYTHON'
import json
import sys
report = json.load(open(sys.argv[1]))
counts = next(line.split() for line in open(sys.argv[2]) if line[:1].isdigit())
angle = report["map"]["distortion"]["angle_change_degrees"]["mean"]
print(f"{counts[1]} triangles, {angle:.2f}°")
PYTHON
  else
    echo "no"
  fi
}

{
  cat <<'TEXT'
# Meshes that are no spheres

Written by `scripts/topology-cases.sh`. Each mesh is given to `shape3d map` as it is, with `--repair`
and with `--wrap`. The mapped ones are certified: one to one. Figures are the triangles that were
mapped and the mean angle change; "no" where the remedy does not make the mesh a surface of genus 0
(`--repair` leaves handles).

| mesh | refused because | `--repair` | `--wrap` |
|:--|:--|:--|:--|
TEXT
  for mesh in "${meshes[@]}"; do
    name=$(basename "$mesh")
    echo "topology-cases: $name" >&2
    if "$program" map "$mesh" -o "$work/s.off" --json "$work/r.json" -q 2>"$work/err"; then
      why="not refused: $(attempt "$mesh")"
    else
      why=$(sed "s|^shape3d: $mesh: ||; s/|/\\\\|/g" "$work/err")
    fi
    echo "| $name | $why | $(attempt "$mesh" --repair) | $(attempt "$mesh" --wrap) |"
  done
} >"$work/page.md"
mkdir -p docs/results
mv "$work/page.md" docs/results/topology-cases.md
