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
trap 'rm -f "$work" "$work.times"' EXIT
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
  "$build/benchmarks/shape3d_mapping_bench" "$@" 2>/dev/null | tee "$work.times"
  echo '```'
  power() { awk -v n="$1" '$1 == n "/4" {a = $2} $1 == n "/7" {printf "%.2f", log($2 / a) / log(64)}' "$work.times"; }
  echo
  echo "Powers of the number of triangles between the smallest and the largest body: $(power BM_linear) (linear), $(power BM_ceres) (with
Ceres)."
  rm -f "$work.times"
  cat <<'EOF'
Half of Ceres' time is CHOLMOD's BLAS (ATLAS). OpenBLAS factors two to three times as fast, but the
build for one thread of Debian 12 gave other bytes when maps were made at the same time.
EOF
} >"$work"
chmod 644 "$work"
mv "$work" "$result"
echo "$result"
