#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A bar that keeps to the window on a terminal, plain lines elsewhere, one line with --quiet.
. "$(dirname "$0")/harness.sh"
run="$program run $scenes/small_elastic.yaml $plain --set output.checkpoint_every_s=0.01"

expect_exit 0 $run --out plain
expect_text stdout '^ *[0-9]+ %  t .*left '
grep -q "$(printf '\r')" stdout && fail "a carriage return in plain lines"
[ "$(grep -c ' %  t ' stdout)" -le 21 ] || fail "more than a line every 5 %"

expect_exit 0 $run --out quiet --quiet
[ "$(wc -l <stdout)" -eq 1 ] || fail "--quiet printed more than its last line"
[ ! -s stderr ] || fail "--quiet printed to the error output"

if ! script -qec true log >/dev/null 2>&1; then
  echo "note: no terminal can be made here"
  done_checking
  exit 0
fi
for columns in 40 79 132; do
  expect_exit 0 env TERM=xterm script -qec \
    "stty cols $columns; $run --set time.end_s=2 --out terminal --force" log
  expect_text log '^finished at t = 2 s'
  # What one carriage return starts is what one line of the window shows.
  grep -v '^Script' log | tr '\r' '\n' | sed 's/\x1b\[K//' | grep ' %  t ' >drawn || true
  [ -s drawn ] || fail "nothing was drawn in $columns columns"
  longest=$(wc -L <drawn)
  checks=$((checks + 1))
  [ "$longest" -lt $columns ] || fail "$longest characters drawn in $columns columns"
done
expect_text drawn '\[=+>? *\]'
done_checking
