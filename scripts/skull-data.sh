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

documentation_file invesalius-examples usr/share/doc/invesalius-examples/examples/Cranium.inv3
