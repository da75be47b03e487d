#!/usr/bin/env bash
# Makes advisor-32.jsonl anew from ../llm-answers: make.sh PATH_OF_TERRA
set -euo pipefail
terra=$(realpath "${1:?usage: make.sh PATH_OF_TERRA}")
here=$(cd "$(dirname "$0")" && pwd)
answers="$here/../llm-answers"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
rm -f "$here/advisor-32.jsonl"
"$terra" bench run --dataset "$answers" --method advisor --backend exchange \
  --exchange "$work/exchange" --model unnamed-llm-native --no-images \
  --record "$here/advisor-32.jsonl" --out "$work/run" &
run=$!
while kill -0 $run 2>/dev/null; do
  for folder in "$work"/exchange/*/; do
    if [ ! -e "$folder/prompt.txt" ] || [ -e "$folder/answer.txt" ]; then continue; fi
    question=$(basename "$folder")
    cp "$answers/answers/native/${question%-*}.txt" "$folder/part"
    mv "$folder/part" "$folder/answer.txt"
  done
  sleep 0.05
done
wait $run
