#!/usr/bin/env bash
# A real Slurm on this one host, from the distribution's packages: an array job
# of scripts/bench-slurm, merged, must equal the run in one piece. Needs root and
# slurmctld, slurmd, munge; exit 77 = skipped.
# usage: slurm_test.sh SCRIPTS_FOLDER PATH_OF_TERRA
set -euo pipefail
scripts=$(realpath "$1") terra=$(realpath "$2")
for program in slurmctld slurmd munged sbatch; do
  command -v "$program" >/dev/null || { echo "skipped: no $program"; exit 77; }
done
[ "$(id -u)" = 0 ] || { echo "skipped: not root"; exit 77; }

work=$(mktemp -d)
pids=()
stop() {
  for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done
  wait
  rm -rf "$work"
}
trap stop EXIT

# Own key, socket and ports, so that a Slurm of the host is not disturbed.
host=$(hostname -s)
dd if=/dev/urandom of="$work/munge.key" bs=128 count=1 status=none
chmod 600 "$work/munge.key"
chmod 755 "$work"
munged --foreground --force --key-file "$work/munge.key" --socket "$work/munge.sock" \
  --pid-file "$work/munged.pid" --log-file "$work/munged.log" \
  --seed-file "$work/munged.seed" &
pids+=($!)
mkdir "$work/state" "$work/spool"
cat >"$work/slurm.conf" <<CONF
ClusterName=terra
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge.sock
CredType=cred/munge
SlurmctldPort=16817
SlurmdPort=16818
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/ctld.pid
SlurmdPidFile=$work/d.pid
SlurmctldLogFile=$work/ctld.log
SlurmdLogFile=$work/d.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$host Default=YES State=UP
CONF
export SLURM_CONF="$work/slurm.conf"
until [ -S "$work/munge.sock" ]; do sleep 0.1; done
slurmctld -D &
pids+=($!)
slurmd -D &
pids+=($!)
for _ in $(seq 100); do
  sinfo -h -o %t 2>/dev/null | grep -q idle && break
  sleep 0.2
done
sinfo || true

"$terra" bench generate --subset easy --count 12 --seed 4 --out "$work/data"
method=(--dataset "$work/data" --method advisor --backend search)
"$terra" bench run "${method[@]}" --out "$work/whole"
export TERRA="$terra" RUN_OUT="$work/run"
sbatch --wait --array=1-3 --output="$work/task-%a.log" \
  "$scripts/bench-slurm" "${method[@]}" || { cat "$work"/*.log; exit 1; }
"$terra" bench merge --out "$work/run" "$work"/run.shards/*

# All columns but the times must be the same.
python3 - "$work/run/results.csv" "$work/whole/results.csv" <<'PYTHON'
import csv
import sys

def rows(path):
    with open(path, newline="") as file:
        found = list(csv.DictReader(file))
    for row in found:
        del row["t_prep"], row["t_det"]
    return found

assert rows(sys.argv[1]) == rows(sys.argv[2]), "the merged run differs"
print(len(rows(sys.argv[1])), "cases, the same as in one piece")
PYTHON
