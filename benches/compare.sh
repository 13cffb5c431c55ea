#!/usr/bin/env bash
# Paths a second and efficiency beside Mitsuba 3, the same scene, interleaved, one thread each:
#
#     benches/compare.sh [--rounds 12] [--spp 64]
#
# Mitsuba comes from PyPI into a folder that is removed at the end. Where no LLVM on this machine can compile its code
# (versions before 19 give up on AVX-512), Debian's libllvm19 is unpacked into the same folder; DRJIT_LIBLLVM_PATH, if
# set, is taken as it is. docs/src/performance.md tells what is measured. Exit status: 0 measured, or Mitsuba cannot be had;
# 1 both renderers do not measure the same, or something broke.
set -euo pipefail
cd "$(dirname "$0")/.."

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

cannot() { echo "no comparison: $1"; exit 0; }

command -v python3 >/dev/null || cannot "there is no python3"
python3 -m venv "$folder/venv" >"$folder/log" 2>&1 || cannot "$(tail -n 1 "$folder/log")"
"$folder/venv/bin/pip" install -q --timeout 10 --retries 1 mitsuba==3.9.1 numpy >"$folder/log" 2>&1 ||
  cannot "$(tail -n 1 "$folder/log")"

libraries=()
if [ -n "${DRJIT_LIBLLVM_PATH:-}" ]; then
  libraries=("$DRJIT_LIBLLVM_PATH")
else
  for library in /usr/lib/*/libLLVM-1[5-9].so.1 /usr/lib/*/libLLVM.so.[12][0-9].*; do
    if [ -e "$library" ]; then libraries+=("$library"); fi
  done
  if ! printf '%s\n' "${libraries[@]}" | grep -qE 'libLLVM\.so\.(19|2)' && command -v apt-get dpkg >/dev/null; then
    if (cd "$folder" && apt-get download libllvm19 && dpkg -x libllvm19_*.deb llvm) >"$folder/log" 2>&1; then
      for library in "$folder"/llvm/usr/lib/*/libLLVM.so.19.*; do libraries+=("$library"); done
    else
      echo "libllvm19 cannot be had: $(tail -n 1 "$folder/log")"
    fi
  fi
fi

cargo build -q --release --locked --bin experiment --example workload
target/release/experiment export cornell_box --resolution 256 --format mitsuba -o "$folder/box.xml" >/dev/null
"$folder/venv/bin/python" benches/compare.py "$folder/box.xml" target/release/examples/workload "$@" \
  --libraries ${libraries[@]+"${libraries[@]}"}
