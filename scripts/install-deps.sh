#!/usr/bin/env bash
# Installs the Debian packages that Shape3D is built, tested and demonstrated with; those that are
# there already are left alone. Asks for root rights by sudo only when something is missing.
set -euo pipefail
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/apt.sh"

packages=(
  build-essential cmake ninja-build ccache                       # build
  libeigen3-dev libtbb-dev                                       # libraries
  libvtk9-dev libvtk-dicom-dev zlib1g-dev                        # programs: volumes, meshes, pictures
  libcgal-dev libceres-dev                                       # libraries: mapping
  libsvm-dev libsvm-tools libhnswlib-dev                         # libraries: learning, and its reference programs
  libsqlite3-dev                                                 # programs: shape libraries
  libvtk9-qt-dev qtbase5-dev                                     # viewer
  libcli11-dev nlohmann-json3-dev libhdf5-dev                    # programs: command line, reports, tables
  xvfb xauth libgl1-mesa-dri                                     # pictures without a display
  catch2 libbenchmark-dev                                        # tests, benchmarks
  python3-nibabel python3-pydicom python3-numpy python3-h5py     # fixtures and checks of the tests
  python3-scipy                                                  # scripts that write results
  imagemagick invesalius-examples libcgal-demo                   # demonstration: a real CT, meshes
)

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
  echo "install-deps: all ${#packages[@]} packages are installed"
  exit 0
fi
echo "install-deps: installing ${missing[*]}"

install() {
  as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install --yes --no-install-recommends "${missing[@]}"
}

all_known() {
  local package
  for package in "${missing[@]}"; do
    apt-cache show "$package" >/dev/null 2>&1 || return 1
  done
}

updated=no
if ! all_known; then
  as_root apt-get update
  updated=yes
fi
if ! install; then
  # Lists older than the archive name files that are gone.
  [[ $updated == no ]] || exit 1
  echo "install-deps: trying again with fresh package lists"
  as_root apt-get update
  install
fi
echo "install-deps: installed ${missing[*]}"
