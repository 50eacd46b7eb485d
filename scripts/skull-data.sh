#!/usr/bin/env bash
# Prints the path of Cranium.inv3, the real CT of the Debian package invesalius-examples: a tar.gz
# whose member */matrix.dat holds 256 x 256 x 108 samples, int16, x fastest, at a spacing of
# 0.9570312 x 0.9570312 x 1.5 mm.
#
# Some container images leave /usr/share/doc out of installed packages. Then the package is
# downloaded and unpacked to $XDG_CACHE_HOME/shape3d (~/.cache/shape3d), once.
set -euo pipefail
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/apt.sh"

inside=usr/share/doc/invesalius-examples/examples/Cranium.inv3
cache=${XDG_CACHE_HOME:-${HOME:?}/.cache}/shape3d
for archive in "/$inside" "$cache/invesalius-examples/$inside"; do
  if [[ -r $archive ]]; then
    echo "$archive"
    exit 0
  fi
done

mkdir -p "$cache"
work=$(mktemp -d "$cache/download-XXXXXX")
trap 'rm -rf "$work"' EXIT
download() (cd "$work" && apt-get -o APT::Sandbox::User=root download invesalius-examples >&2)
if ! download; then
  as_root apt-get update >&2
  download
fi
dpkg-deb --extract "$work"/invesalius-examples_*.deb "$work/unpacked"
if [[ ! -r $work/unpacked/$inside ]]; then
  echo "error: $inside is not in the package invesalius-examples" >&2
  exit 1
fi
rm -rf "$cache/invesalius-examples"
mv "$work/unpacked" "$cache/invesalius-examples"
echo "$cache/invesalius-examples/$inside"
