#!/usr/bin/env bash
# Measures the time of spherical maps by size and writes docs/benchmarks/mapping.md.
#   SHAPE3D_DATA=<folder>  with genus0/{brain_choi_97k,lion_choi_100k,bunny_60k}.off: adds these
#   SHAPE3D_BUILD=<folder> a build with SHAPE3D_BUILD_BENCHMARKS=ON (default build/bench)
#   SHAPE3D_NOTE=<text>    said of the machine, for example that it was busy
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${SHAPE3D_BUILD:-build/bench}
[[ -f $build/CMakeCache.txt ]] || cmake --preset bench >/dev/null
cmake --build "$build" --target shape3d_mapping_bench >&2

mkdir -p docs/benchmarks
result=docs/benchmarks/mapping.md
work=$(mktemp "$result.XXXXXX")
trap 'rm -f "$work"' EXIT
{
  cat <<EOF
# Time of spherical maps

\`scripts/benchmark-mapping.sh\` writes this page.

$(sed -n 's/^model name\s*: //p' /proc/cpuinfo | head -1), one thread${SHAPE3D_NOTE:+; $SHAPE3D_NOTE}. \`BM_linear/4\` to \`/7\` and \`BM_ceres/4\`
to \`/7\` map one star-shaped body of 20 · 4^k triangles: 5,120, 20,480, 81,920 and 327,680. *BigO* is
the law fitted to them and *s_per_100k* the seconds for 100,000 triangles. \`bunny_60k_subdivided\` has
238,656 triangles.

\`\`\`
EOF
  "$build/benchmarks/shape3d_mapping_bench" "$@" 2>/dev/null
  echo '```'
} >"$work"
chmod 644 "$work"
mv "$work" "$result"
echo "$result"
