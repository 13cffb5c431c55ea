#!/usr/bin/env bash
# Promise: an experiment that runs as a job array on a Slurm cluster yields the bytes that it yields on one machine, whatever
# happens to its tasks in between; and what has happened is told.
#
#     tests/slurm/run.sh [PROGRAM]
#
# Wants Slurm and munge (Debian: slurmctld slurmd slurm-client slurm-wlm-basic-plugins munge), and the rights of root, if
# need be by `sudo -n`. The cluster is this machine's alone, lives in a temporary folder and is gone at the end.
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=$(realpath "${1:-$here/../../target/debug/experiment}")
[ "$(id -u)" = 0 ] || exec sudo -n "$here/run.sh" "$program"
PATH=$PATH:/usr/sbin # where the daemons are
. "$here/cluster.sh"

root=$(mktemp -d -t furnace-slurm.XXXXXX)
chmod 755 "$root"
# a name that a shell, or Slurm, could take for something else
work="$root/it's a \"place\" \$of %j; work"
reports=$work/reports
end() {
  local status=$?
  [ "$status" = 0 ] || { scontrol -o show job; tail -n 30 "$root"/*.log "$reports"/parts.slurm/*.log; } 2>/dev/null
  cluster_down "$root"
  rm -rf "$root"
  exit "$status"
}
trap end EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

see() { printf '%3d s  %s\n' "$SECONDS" "$*"; }
fail() { printf '%3d s  FAILED: %s\n' "$SECONDS" "$*" >&2; exit 1; }

# task N KEY: what Slurm knows of a task
task() { scontrol -o show job "${array}_$1" | grep -oP "(?<= $2=)\S*"; }
is() { [ "$(task "$1" "$2")" = "$3" ]; }
log() { cat "$reports/parts.slurm/$1.log" 2>/dev/null; }
journal() { echo "$reports/parts.journal/$1-of-8.journal"; }
# journal_has N LINES: more than so many; the first one is no block
journal_has() { [ "$(wc -l 2>/dev/null <"$(journal "$1")" || echo 0)" -gt "$2" ]; }
is_under_way() { is "$1" JobState RUNNING && journal_has "$1" 2; }
is_up() { [[ "$(sinfo -h -n "$1" -p work -o %T)" =~ ^(idle|mixed|allocated)$ ]]; }

# The process that runs a task's part.
program_of() { pgrep -f -- "^$program .*--shard $1/8 .*$root/"; }

# Waits until a task has written something, and notes what.
catch() {
  within 60 is_under_way "$1" || fail "task $1 does not get going"
  cp "$(journal "$1")" "$root/$1.noted"
}

# What was noted is still there, and more.
went_on() {
  cmp -s -n "$(stat -c %s "$root/$1.noted")" "$root/$1.noted" "$(journal "$1")" || fail "task $1 did not keep what it had"
  journal_has "$1" "$(wc -l <"$root/$1.noted")" || fail "task $1 did not go on"
}

comes_back() {
  within 10 is "$1" Restarts 1 || fail "task $1 is not brought back after it $2"
  see "task $1 $2: it waits for another turn"
}

ended() { [ -z "$(squeue -h -j "$1" 2>/dev/null)" ]; }

submit() {
  (cd "$work" && "$program" slurm parts --tasks 8 --submit --mem 100 --time 1-0) >"$root/submitted" || fail "cannot submit"
  array=$(grep -oP 'job array \K\d+' "$root/submitted") && merge=$(grep -oP ', job \K\d+' "$root/submitted") ||
    fail "no numbers of jobs are printed: $(cat "$root/submitted")"
  see "submitted: array $array, merge $merge"
}

# merged STATE EXITCODE: how the merge ends
merged() {
  within 90 ended "$array,$merge" || fail "this does not end"
  local found
  found=$(scontrol -o show job "$merge" | grep -oP '(JobState|ExitCode)=\K\S*' | paste -sd' ')
  [ "$found" = "$1 $2" ] || fail "the merge ends $found, not $1 $2: $(cat "$reports/parts.slurm/merge.log")"
  see "the merge ends $found: $(tail -n 1 "$reports/parts.slurm/merge.log")"
}

# Percent of the whole that are there, as `status` says.
percent() {
  local said
  said=$("$program" status "$reports/parts.journal" 2>&1 | tail -n 1)
  see "status: $said" >&2
  grep -oP '[0-9.]+(?= %)' <<<"$said"
}
# is_within LEAST PERCENT MOST
is_within() { awk -v least="$1" -v p="${2:-none}" -v most="$3" 'BEGIN { exit !(p ~ /^[0-9.]+$/ && least <= p && p <= most) }'; }

mkdir -p "$work/experiments"
cp "$here/parts.toml" "$work/experiments"
(cd "$work" && "$program" parts --quiet --out alone >/dev/null) || fail "the experiment itself fails"
see "run as a whole"
cluster_up "$root" || fail "no cluster"
see "a cluster is up: $(sinfo -h -p work -o '%N %T')"
submit

catch 1
told=$(percent)
is_within 0.1 "$told" 25 || fail "status says $told % while the first two tasks of eight run"
kill -KILL "$(program_of 1)"
comes_back 1 "was killed"
catch 2
node=$(task 2 NodeList)
node_dies "$node"
scontrol update nodename="$node" state=down reason="no power"
comes_back 2 "lost its node $node"
node_up "$node"
within 20 is_up "$node" || fail "$node does not come back"
catch 3
scontrol requeue "${array}_3"
comes_back 3 "was requeued"
catch 4
kill -TERM "$(ps -o ppid= -p "$(program_of 4)" | tr -d ' ')" # what Slurm does a minute before the time limit
comes_back 4 "was told that its time is over"
catch 5
scancel "${array}_5"
see "task 5 is cancelled"
catch 6
sbatch --parsable --partition=urgent --nodelist="$(task 6 NodeList)" --output=/dev/null --wrap "sleep 1" >/dev/null
comes_back 6 "had to give way"

merged FAILED 75:0
for n in 1 2 3 4 6 7 8; do
  is "$n" JobState COMPLETED && is "$n" ExitCode 0:0 || fail "task $n ends $(task "$n" JobState) $(task "$n" ExitCode)"
done
for n in 1 2 3 4 6; do went_on "$n"; done
is 5 JobState CANCELLED && is 5 Restarts 0 || fail "task 5 does not stay cancelled"
for n in 7 8; do is "$n" Restarts 0 || fail "task $n was started again for nothing"; done
see "all tasks but the cancelled one are complete, and have gone on from where they were"
told=$(percent)
is_within 87 "$told" 99.9 || fail "status says $told % while one part of eight is missing"

submit
merged COMPLETED 0:0
went_on 5
[ "$(percent)" = 100.0 ] || fail "status does not say that all is there"
cmp "$work/alone/parts/results.csv" "$reports/parts/results.csv" || fail "the parts do not make the whole"
see "results.csv is that of the whole run, byte for byte"

sed -i s/question/quest/ "$work/experiments/parts.toml"
array=$(sbatch --parsable --array=1 "$reports/parts.slurm/shards.sbatch")
within 20 ended "$array" || fail "what is refused does not end"
is 1 ExitCode 2:0 && is 1 Restarts 0 || fail "what is refused ends $(task 1 ExitCode) after $(task 1 Restarts) restarts"
see "what is refused is not tried again"
