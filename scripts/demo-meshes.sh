#!/usr/bin/env bash
# Prints the path of data.tar.gz of the Debian package libcgal-demo, whose folder data/meshes holds
# meshes of many kinds.
#
# Some container images leave /usr/share/doc out of installed packages. Then the package is
# downloaded and unpacked to $XDG_CACHE_HOME/shape3d (~/.cache/shape3d), once.
set -euo pipefail
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/apt.sh"
documentation_file libcgal-demo usr/share/doc/libcgal-dev/data.tar.gz
