#!/usr/bin/env bash
# check_model.sh MODEL CC whole    nothing is wrong with the model
#                         M_RULE   without this rule something is
#                         -M_RULE  without this rule another one covers for it
set -euo pipefail
model=$1 cc=$2 rule=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

case $rule in
  M_*) expected=1 ;;
  *) expected=0 ;;
esac
spin "-D${rule#-}" -a "$model" >spin.txt || { cat spin.txt; exit 1; }
"$cc" -O1 -w -DVECTORSZ=512 -DSAFETY -o pan pan.c
./pan -m200000 -w22 | tee pan.txt
# A search that was cut short has proved nothing, and "assertion violated" is
# the only kind of error that counts.
if [ $expected = 0 ]; then
  grep -q 'errors: 0' pan.txt && ! grep -qE 'max search depth|out of memory' pan.txt
else
  grep -q 'assertion violated' pan.txt
fi
