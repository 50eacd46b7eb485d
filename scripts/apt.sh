# shellcheck shell=bash
# Sourced by scripts that use apt.

if ! command -v apt-get >/dev/null; then
  echo "error: apt-get not found; this script knows Debian and Ubuntu only" >&2
  exit 1
fi

# Runs a command as root: directly, or by sudo.
as_root() {
  if [[ $(id -u) -eq 0 ]]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    echo "error: '$*' must be run as root, and there is no sudo" >&2
    exit 1
  fi
}

# Prints the path of a file below usr/share/doc that a Debian package holds. Where the installed
# package is without it, the package is downloaded and unpacked to the user's cache, once.
documentation_file() (
  package=$1 inside=$2
  cache=${XDG_CACHE_HOME:-${HOME:?}/.cache}/shape3d
  for file in "/$inside" "$cache/$package/$inside"; do
    if [[ -r $file ]]; then
      echo "$file"
      exit 0
    fi
  done
  mkdir -p "$cache"
  work=$(mktemp -d "$cache/download-XXXXXX")
  trap 'rm -rf "$work"' EXIT
  download() (cd "$work" && apt-get -o APT::Sandbox::User=root download "$package" >&2)
  if ! download; then
    as_root apt-get update >&2
    download
  fi
  dpkg-deb --extract "$work/$package"_*.deb "$work/unpacked"
  if [[ ! -r $work/unpacked/$inside ]]; then
    echo "error: $inside is not in the package $package" >&2
    exit 1
  fi
  rm -rf "${cache:?}/$package"
  mv "$work/unpacked" "$cache/$package"
  echo "$cache/$package/$inside"
)
