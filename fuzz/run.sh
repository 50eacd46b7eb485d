#!/usr/bin/env bash
# Fuzzes one target for some minutes at the lowest priority, from its seeds, its kept inputs and what earlier
# runs found.
#
#   fuzz/run.sh TARGET [MINUTES]        MINUTES is 20 unless given; FUZZ_BUILD is build/fuzz
#
# New inputs go to FUZZ_BUILD/corpus/TARGET; an input with a finding, as crash-…, oom-… or timeout-…, to
# FUZZ_BUILD/findings/TARGET, with the log beside it. Exit status 0: no finding.
set -euo pipefail
source=$(cd "$(dirname "$0")" && pwd)
target=${1:?"usage: fuzz/run.sh TARGET [MINUTES]"}
minutes=${2:-20}
build=${FUZZ_BUILD:-$source/../build/fuzz}
corpus=$build/corpus/$target
findings=$build/findings/$target
mkdir -p "$corpus" "$findings"

arguments=(-max_total_time=$((60 * minutes)) -timeout=300 -rss_limit_mb=2048 -max_len=16384 -print_final_stats=1
  -artifact_prefix="$findings/")
dictionary=$source/dictionaries/$target.dict
[[ -f $dictionary ]] && arguments+=("-dict=$dictionary")
inputs=("$corpus" "$build/fuzz/seeds/$target")
[[ -d $source/regressions/$target ]] && inputs+=("$source/regressions/$target")

export ASAN_OPTIONS=detect_stack_use_after_return=1
status=0
TIMEFORMAT='%R s, of which %U + %S s of processor time'
time nice -n 19 "$build/fuzz/shape3d_fuzz_$target" "${arguments[@]}" "${inputs[@]}" > "$findings/log" 2>&1 || status=$?
grep -E "DONE|^Done|stat::|SUMMARY|violated|unexpected exception|cannot" "$findings/log" || true
exit $status
