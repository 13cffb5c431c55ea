#!/usr/bin/env bash
# Instructions a path, counted by callgrind, which a busy machine does not disturb:
#
#     benches/instructions.sh [--check | --write] [--release]
#
# Prints them beside those of benches/instructions.csv. --check fails where a count has grown by more than 5 %, --write
# puts the new ones into the file. The file holds the dev profile, which `cargo run` and `cargo test` use and have built.
#
# Each count is the difference of two runs that differ only in their number of paths, so that start-up drops out.
# Valgrind knows no AVX-512 and shows every program the same processor, with AVX2 where the machine has it: the count
# depends on the compiler, and not on the machine. With another compiler than the file's, growth is told and is no failure.
set -euo pipefail
cd "$(dirname "$0")/.."

check=false write=false release=()
for option in "$@"; do
  case $option in
    --check) check=true ;;
    --write) write=true ;;
    --release) release=(--release) ;;
    *) echo "unknown option $option"; exit 2 ;;
  esac
done
if [ ${#release[@]} -gt 0 ] && { $check || $write; }; then
  echo "the file holds counts of the dev profile only"
  exit 2
fi

file=benches/instructions.csv
skip() { echo "skipped: $1"; exit 0; }
command -v valgrind >/dev/null || skip "there is no valgrind"
[ "$(uname -m)" = x86_64 ] || skip "the counts are those of x86_64"

cargo build -q --locked --example workload ${release[@]+"${release[@]}"}
program=${CARGO_TARGET_DIR:-target}/debug/examples/workload
if [ ${#release[@]} -gt 0 ]; then program=${CARGO_TARGET_DIR:-target}/release/examples/workload; fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# instructions of so many realizations, and their number of paths
run() {
  if ! valgrind --tool=callgrind --callgrind-out-file=/dev/null "$program" "$1" "$2" "$3" 0 64 \
    >"$folder/out" 2>"$folder/log"; then
    cat "$folder/log" >&2
    return 1
  fi
  local paths set
  read -r _ paths _ set <"$folder/out"
  if [ "$set" != avx2 ]; then
    echo "$set" >"$folder/set"
    return 1
  fi
  echo "$(awk '/Collected/ { print $4 }' "$folder/log") $paths"
}

# WORKLOAD CORE FEW MANY
counts() {
  local few many
  few=$(run "$1" "$2" "$3") && many=$(run "$1" "$2" "$4") || return 1
  awk -v few="$few" -v many="$many" -v name="$1,$2" \
    'BEGIN { split(few, a, " "); split(many, b, " "); printf "%s,%.0f\n", name, (b[1] - a[1]) / (b[2] - a[2]) }'
}

compiler=$(rustc --version)
{
  echo "# $compiler"
  echo "workload,core,instructions"
  for workload in "light textbook 1 9" "light fast 1 9" "both textbook 1 9" "both fast 1 9" "furnace textbook 1000 33768" \
    "furnace fast 1000 33768" "photons textbook 1 4" "photons fast 1 4"; do
    # shellcheck disable=SC2086 # four words
    counts $workload || { [ -e "$folder/set" ] || exit 1; break; }
  done
} >"$folder/counts.csv"
[ ! -e "$folder/set" ] || skip "under valgrind this machine shows $(cat "$folder/set"), and no AVX2"

status=0
awk -F, -v check="$check" -v release="${#release[@]}" '
  FILENAME == ARGV[1] && /^#/ { old_compiler = $0 }
  FILENAME == ARGV[1] { before[$1 "," $2] = $3; next }
  /^#/ { other = $0 != old_compiler; compiler = $0; next }
  /^workload/ { printf "%-20s %12s %12s\n", "", "instructions", release ? "dev profile" : "in the file"; next }
  {
    key = $1 "," $2; was = before[key]
    printf "%-20s %12d %12s", $2 ", " $1, $3, was ? was : "-"
    if (was) printf " %+7.1f %%", 100 * ($3 / was - 1)
    print ""
    if (!was || $3 > 1.05 * was) grown = grown " " key
    else if ($3 < 0.95 * was) fallen = fallen " " key
  }
  END {
    if (release) exit
    if (fallen) print "fallen by more than 5 %:" fallen "; note it with benches/instructions.sh --write"
    if (grown) print "grown by more than 5 %, or not in the file:" grown
    if (grown && other) print "the file was made by " substr(old_compiler, 3) ", and this is " substr(compiler, 3)
    if (grown && !other && check == "true") { print "if it must be so: benches/instructions.sh --write"; exit 1 }
  }' "$([ -e $file ] && echo $file || echo /dev/null)" "$folder/counts.csv" || status=$?

if $write; then cp "$folder/counts.csv" $file; fi
exit $status
