# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by tests/check_*.sh as `. harness.sh` with BUILD_DIR SOURCE_DIR as arguments: names the
# program, makes a folder $work that goes away at the end, and counts what was checked.
set -eu
build=$(cd "$1" && pwd)
source_dir=$(cd "$2" && pwd)
program=$build/pilewright
scenes=$source_dir/tests/scenes
work=$(mktemp -d "${TMPDIR:-/tmp}/pilewright_check.XXXXXX")
checks=0
# Threads that wait must not keep others from a core: tests share the machine.
export OMP_NUM_THREADS=1 OMP_WAIT_POLICY=passive OMP_PROC_BIND=false

finish() {
  code=$?
  kill -9 $(jobs -p) 2>/dev/null || true
  chmod -R u+w "$work" 2>/dev/null || true
  rm -rf "$work"
  exit $code
}
trap finish EXIT
cd "$work"
[ -x "$program" ] || { echo "no program $program"; exit 1; }

fail() {
  echo "FAILED: $*"
  for log in stdout stderr; do
    [ -s "$work/$log" ] && { echo "--- $log"; tail -n 20 "$work/$log"; }
  done
  exit 1
}

# expect_exit CODE COMMAND...: run it, keep its output in $work/stdout and $work/stderr.
expect_exit() {
  want=$1
  shift
  got=0
  "$@" >"$work/stdout" 2>"$work/stderr" </dev/null || got=$?
  checks=$((checks + 1))
  [ "$got" -eq "$want" ] || fail "exit status $got, expected $want: $*"
}

# expect_text FILE REGEX
expect_text() {
  checks=$((checks + 1))
  grep -Eq -- "$2" "$1" || fail "no text matching '$2' in $1"
}

expect_file() {
  checks=$((checks + 1))
  [ -s "$1" ] || fail "$1 is missing or empty"
}

expect_absent() {
  checks=$((checks + 1))
  [ ! -e "$1" ] || fail "$1 should not exist"
}

# expect_same FILE FILE: byte for byte.
expect_same() {
  checks=$((checks + 1))
  cmp "$1" "$2" || fail "$1 and $2 differ"
}

# expect_status FOLDER STATUS: what its summary says.
expect_status() {
  expect_text "$1/summary.json" "\"status\": \"$2\""
}

done_checking() {
  echo "$checks checks passed"
}

# Scenes without pictures and ParaView files, for checks that need neither.
plain="--set output.pictures=false --set output.paraview=false"
