#!/usr/bin/env bash
# Each check of scripts/check passes on a small sound project and fails when one
# fault is put into it.
# usage: check_canaries.sh SOURCE_ROOT
set -euo pipefail
source_root=$1
project=$(mktemp -d)
trap 'rm -rf "$project"' EXIT

# A project with as much of ours as the checks read.
make_project() {
  rm -rf "${project:?}"/* "$project"/.[a-z]*
  mkdir -p "$project"/{terrain,tests,docs,.ci}
  cp -r "$source_root/scripts" "$source_root/.clang-format" "$source_root/.clang-tidy" \
    "$source_root/.codespellrc" "$project"
  for folder in verifier bus planner advisor logger benchmark chaos cli output; do
    mkdir "$project/$folder"
  done
  cat >"$project/terrain/cell.h" <<'END'
#pragma once

/// A cell of the map.
struct Cell {
  int x = 0;  ///< Grows to the right.
};
END
  # shellcheck disable=SC2016  # Not quoted for the script that it writes.
  printf '#!/bin/sh\necho "$1"\n' >"$project/tests/say.sh"
  printf 'import sys\n\nprint(sys.argv)\n' >"$project/tests/say.py"
  printf '# Words\n\nPlain words.\n' >"$project/docs/words.md"
  git -C "$project" init -q
  git -C "$project" add -A
}

# run NAME: scripts/check of the project.
run() { "$project/scripts/check" --no-install "$1" >"$project/said.log" 2>&1; }

# catches NAME FILE LINE: with that line at its end the check fails and names FILE.
catches() {
  make_project
  run "$1" || { cat "$project/said.log"; echo "$1 fails on a sound project"; exit 1; }
  printf '%s\n' "$3" >>"$project/$2"
  if run "$1"; then echo "$1 does not see: $3"; exit 1; fi
  grep -q "$(basename "$2")" "$project/said.log" ||
    { cat "$project/said.log"; echo "$1 does not name $2"; exit 1; }
  echo "$1 sees a fault"
}

catches format terrain/cell.h 'int   Badly(  int y){return y;}'
# shellcheck disable=SC2016  # The fault is that it is not quoted.
catches shell tests/say.sh 'cat $1'
catches python tests/say.py 'print(nothing)'
catches spelling docs/words.md "This is t""eh word."
catches doxygen terrain/cell.h '/// \param z none
int Of(int y);'

# tidy, on one file: clean, then clean from what it noted, then with a fault.
make_project
cat >"$project/terrain/last.cc" <<'END'
#include <vector>

int Last(const std::vector<int>& values) {
  return values.back();
}
END
cat >"$project/compile_commands.json" <<END
[{"directory": "$project", "file": "terrain/last.cc",
  "command": "c++ -std=c++20 -o last.o -c terrain/last.cc"}]
END
tidy() { "$project/scripts/tidy" --build "$project" "$project/terrain/last.cc" >"$project/said.log" 2>&1; }
tidy || { cat "$project/said.log"; exit 1; }
begin=$(stat -c %Y "$project"/tidy/*)
tidy || { cat "$project/said.log"; exit 1; }
[ "$begin" = "$(stat -c %Y "$project"/tidy/*)" ] || { echo "tidy forgot what it saw"; exit 1; }
sed -i 's/const std::vector<int>& values/const std::vector<int> values/' "$project/terrain/last.cc"
if tidy; then echo "tidy does not see a copy"; exit 1; fi
grep -q 'performance-unnecessary-value-param' "$project/said.log" ||
  { cat "$project/said.log"; exit 1; }
echo "tidy sees a fault"
