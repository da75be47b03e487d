#!/usr/bin/env bash
# Draws multiterrapath-like v1 and compares it with the digest that CHANGELOG.md
# records: the released maps must not change unnoticed.
# usage: released_set_test.sh TERRA CHANGELOG.md
set -euo pipefail
terra=$1 changelog=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# shellcheck disable=SC2016  # The backquotes are Markdown's.
recorded=$(sed -n 's/^| dataset `multiterrapath-like` | 1,.*digest `\([0-9a-f]\{64\}\)`.*/\1/p' "$changelog")
[ -n "$recorded" ] || { echo "no digest of v1 in $changelog"; exit 1; }
"$terra" bench generate --paper --out "$folder/v1" | tee "$folder/said"
grep -q ": 2000 cases, digest $recorded\$" "$folder/said" ||
  { echo "recorded: $recorded"; exit 1; }
cd "$folder/v1"
sha256sum --check --strict --quiet SHA256SUMS
[ "$(find . -type f ! -name SHA256SUMS | wc -l)" = "$(wc -l <SHA256SUMS)" ] ||
  { echo "SHA256SUMS does not name every file"; exit 1; }
