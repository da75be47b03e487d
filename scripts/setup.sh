# Sourced by the other scripts: installs packages, builds, checks the network.
# shellcheck shell=bash

# (With CDPATH set, cd may print where it went.)
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." >/dev/null && pwd)

say() { printf '%s\n' "$*" >&2; }

fail() {
  say "error: $*"
  exit 1
}

# Every script takes --no-install, before a "--", and hands it on to those that
# it starts; what is left are the script's own options.
export TERRA_NO_INSTALL=${TERRA_NO_INSTALL:-}
own_options=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  if [ "$1" = --no-install ]; then TERRA_NO_INSTALL=yes; else own_options+=("$1"); fi
  shift
done
set -- "${own_options[@]}" "$@"

# as_root COMMAND...: fails without a word where there is no root to be had, so
# that the caller says what the user should do.
as_root() {
  if [ "$(id -u)" = 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    return 1
  fi
}

# missing_packages GROUP: those of its packages that are not installed, one a line.
missing_packages() {
  local package
  # shellcheck disable=SC2013  # Names of packages are words.
  for package in $(awk -v group="$1" '$1 == group { print $2 }' \
    "$root/scripts/packages"); do
    # (A line for each architecture that it is known for.)
    dpkg-query -W -f '${db:Status-Status}\n' "$package" 2>/dev/null |
      grep -x installed >/dev/null || echo "$package"
  done
}

# Whether CMake finds all that the build needs. It may lie elsewhere than in
# packages, say an LCM of one's own in a folder that CMAKE_PREFIX_PATH names.
configures() {
  if [ -e "$root/build/release/CMakeCache.txt" ]; then
    (cd "$root" && cmake --preset release) >/dev/null 2>&1
  else
    local scratch found=0
    scratch=$(mktemp -d)
    (cd "$root" && cmake --preset release -B "$scratch" -DTERRA_BUILD_TESTS=OFF) \
      >/dev/null 2>&1 || found=1
    rm -rf "$scratch"
    return $found
  fi
}

# install_packages GROUP...: installs what is missing of the groups, naming it.
install_packages() {
  local group missing
  for group in "$@"; do
    # shellcheck disable=SC2207  # Names of packages are words.
    missing=($(missing_packages "$group"))
    if [ ${#missing[@]} -eq 0 ]; then
      continue
    elif [ "$TERRA_NO_INSTALL" = yes ]; then
      say "not installed (--no-install): ${missing[*]}"
    elif [ "$group" = run ]; then
      install_for_build "${missing[@]}"
    else
      apt_install "${missing[@]}"
    fi
  done
}

# install_for_build PACKAGE...: those without which the build does not configure.
# LCM comes last, as it is what people have of their own.
install_for_build() {
  local package lcm=() others=()
  if ! configures; then
    for package in "$@"; do
      if [[ $package == liblcm-* ]]; then lcm+=("$package"); else others+=("$package"); fi
    done
    apt_install "${others[@]}"
    if [ ${#lcm[@]} -eq 0 ] || { [ ${#others[@]} -gt 0 ] && configures; }; then
      return
    fi
    apt_install "${lcm[@]}"
  fi
}

apt_updated=no
apt_install() {
  [ $# -gt 0 ] || return 0
  say "installing from the distribution: $*"
  local log update=(as_root apt-get update -q)
  log=$(mktemp)
  [ $apt_updated = no ] || update=(true)
  { "${update[@]}" && as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -q -y --no-install-recommends "$@"; } >"$log" 2>&1 || {
    tail -n 20 "$log" >&2
    rm -f "$log"
    fail "could not install: $*
Install them as root (apt-get install $*) and start again.
Where all that is needed is there without these packages, start with --no-install."
  }
  apt_updated=yes
  rm -f "$log"
}

# build PRESET TARGET...: configures and builds, quiet unless it fails.
build() {
  local preset=$1 log="$root/build/$1.log" begin=$SECONDS
  shift
  # Where nothing can be written, what an earlier build left would be run.
  { mkdir -p "$root/build" && (: >>"$log"); } 2>/dev/null ||
    fail "cannot write to $log, so nothing can be built here: the checkout is
read-only, or somebody else (root?) built in it. Copy it without its build folder
to where you may write, and start it there."
  say "building ($preset)"
  (cd "$root" && cmake --preset "$preset" "${cmake_options[@]}" &&
    cmake --build --preset "$preset" --target "$@") >"$log" 2>&1 || {
    { grep -E -A5 'error|FAILED|CMake Error' "$log" || tail -n 20 "$log"; } |
      head -n 60 >&2 || true
    fail "the build failed; the whole output is in $log"
  }
  say "  built ($preset) in $((SECONDS - begin)) s"
}
cmake_options=()

# ensure_multicast: LCM needs a route for its multicast group. Adds one on the
# loopback interface when there is none and that is allowed.
ensure_multicast() {
  # Without the tool to look, the programs say it when they start.
  command -v ip >/dev/null || return 0
  if ip route get 239.255.76.67 >/dev/null 2>&1; then
    return
  fi
  local up=(ip link set lo up multicast on) route=(ip route add 224.0.0.0/4 dev lo)
  say "no multicast route: adding one on lo (${up[*]}; ${route[*]})"
  { as_root "${up[@]}" && as_root "${route[@]}"; } ||
    fail "LCM needs a multicast route. Run both as root:
  ${up[*]}
  ${route[*]}
Without root, a network of its own will do, which only this command sees:
  unshare -rn $0"
}
