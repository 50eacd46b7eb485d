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
