# Sourced by the other scripts: installs packages, builds, checks the network.
# shellcheck shell=bash

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say() { printf '%s\n' "$*" >&2; }

fail() {
  say "error: $*"
  exit 1
}

as_root() {
  if [ "$(id -u)" = 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    fail "this needs root and there is no sudo; run as root: $*"
  fi
}

# install_packages GROUP...: installs what is missing of the groups, naming it.
install_packages() {
  local wanted missing=() package
  wanted=$(awk -v groups=" $* " \
    '$1 !~ /^#/ && index(groups, " " $1 " ") { print $2 }' "$root/scripts/packages")
  for package in $wanted; do
    if [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" != installed ]; then
      missing+=("$package")
    fi
  done
  if [ ${#missing[@]} -eq 0 ]; then
    return
  fi
  say "installing from the distribution: ${missing[*]}"
  local log
  log=$(mktemp)
  if ! { as_root apt-get update -q &&
    as_root env DEBIAN_FRONTEND=noninteractive \
      apt-get install -q -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    fail "could not install: ${missing[*]}
Install them by hand (apt-get install ${missing[*]}) and start again."
  fi
  rm -f "$log"
}

# build PRESET TARGET...: configures and builds, quiet unless it fails.
build() {
  local preset=$1 log="$root/build/$1.log"
  shift
  mkdir -p "$root/build"
  say "building ($preset)"
  if ! (cd "$root" && cmake --preset "$preset" "${cmake_options[@]}" &&
    cmake --build --preset "$preset" --target "$@") >"$log" 2>&1; then
    grep -E -A5 'error|FAILED|CMake Error' "$log" | head -n 60 >&2
    fail "the build failed; the whole output is in $log"
  fi
}
cmake_options=()

# ensure_multicast: LCM needs a route for its multicast group. Adds one on the
# loopback interface when there is none and that is allowed.
ensure_multicast() {
  if ip route get 239.255.76.67 >/dev/null 2>&1; then
    return
  fi
  local up=(ip link set lo up multicast on) route=(ip route add 224.0.0.0/4 dev lo)
  say "no multicast route: adding one on lo (${route[*]})"
  if ! { as_root "${up[@]}" && as_root "${route[@]}"; }; then
    fail "LCM needs a multicast route. Run as root:
  ${up[*]}
  ${route[*]}"
  fi
}
