#!/usr/bin/env bash
# Retrieval and classification of chapter 5 on the training half of the Princeton Shape Benchmark, by
# cross-validation; writes docs/results/chapter-5.md and its pictures.
#   SHAPE3D_DATA=<folder>   with psb/db and psb/classification
#   SHAPE3D_BUILD=<folder>  a build of the programs (default build/release)
#   SHAPE3D_WORK=<folder>   keeps vectors between runs (default: a temporary one)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
: "${SHAPE3D_DATA:?the folder with psb/}"
build=${SHAPE3D_BUILD:-build/release}
program=$build/apps/shape3d/shape3d
[[ -x $program ]] || { echo "error: $program is not there; build the programs first" >&2; exit 2; }
if [[ -n ${SHAPE3D_WORK:-} ]]; then
  work=$SHAPE3D_WORK
else
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
fi
mkdir -p "$work" docs/results docs/images

psb=$SHAPE3D_DATA/psb
# evaluate NAME ARGUMENTS… [after VECTORS: the vectors of another report are taken over]
evaluate() {
  local name=$1
  shift
  [[ -f $work/$name/report.json ]] && return
  "$program" evaluate --db-dir "$psb/db" --test-cla "$psb/classification/v1/base/train.cla" \
    --output "$work/$name" --quiet "$@"
}
share() { # vectors of report $1 for report $2
  mkdir -p "$work/$2"
  [[ -f $work/$2/vectors.h5 ]] || cp "$work/$1/vectors.h5" "$work/$2/"
}

evaluate base-model --metric learned --folds 5
share base-model base-class
evaluate base-class --metric learned --folds 5 --fold-by class
evaluate coarse2 --classes coarse2 --baseline --svm --weighted --folds 5
share coarse2 coarse3
evaluate coarse3 --classes coarse3 --baseline --svm --folds 5
evaluate weighted --classes coarse2 --descriptor hsh:K=8,unit=yes@L2 --svm --weighted --metric fusion \
  --folds 5
evaluate leave-one-out --classes coarse2 --descriptor hsh:K=8,unit=yes@L2 \
  --descriptor csm:R=5,K=8,weighted=yes,unit=yes@L2 \
  --svm --metric fusion --leave-one-out
evaluate pose --classes coarse2 --metric fusion \
  --descriptor hsh:map=two_sided,K=8,fill=binary@L2 \
  --descriptor hsh:map=two_sided,K=8,fill=binary,align=cpca@L2 \
  --descriptor hsh:K=8,unit=yes@L2 --descriptor hsh:K=8,unit=yes,align=cpca@L2

for picture in precision-recall precision-recall-classes correct-classification confusion; do
  install -m 644 "$work/coarse2/$picture.png" "docs/images/chapter-5-$picture.png"
done
install -m 644 "$work/coarse3/precision-recall.png" docs/images/chapter-5-set-1-precision-recall.png
install -m 644 "$work/pose/precision-recall.png" docs/images/chapter-5-pose-precision-recall.png
install -m 644 "$work/weighted/precision-recall.png" docs/images/chapter-5-weighted-precision-recall.png
install -m 644 "$work/base-model/precision-recall.png" docs/images/chapter-5-base-precision-recall.png
/usr/bin/python3 scripts/chapter_5.py "$work" >"$work/page.md"
install -m 644 "$work/page.md" docs/results/chapter-5.md
echo docs/results/chapter-5.md
