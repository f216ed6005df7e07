#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A run that was interrupted or killed goes on to the same bytes as one that was not.
# PW_KILLS: how many times to kill (3; 10 with PW_NIGHTLY=1); PW_SCENE: another scene.
. "$(dirname "$0")/harness.sh"
scene=${PW_SCENE:-$scenes/small_elastic.yaml}
kills=${PW_KILLS:-$([ "${PW_NIGHTLY:-0}" = 1 ] && echo 10 || echo 3)}
options="$plain --threads 2 --set output.checkpoint_every_s=0.05"
[ -n "${PW_SCENE:-}" ] || options="$options --set time.end_s=${PW_END_S:-3}"

seconds() { date +%s.%N; }
begin=$(seconds)
expect_exit 0 "$program" run "$scene" $options --out whole
wall=$(awk "BEGIN{print $(seconds) - $begin}")
expect_status whole finished

# A random part of the time that the whole run took.
sleep_part() {
  sleep "$(awk "BEGIN{srand($RANDOM); print $wall * (0.1 + 0.8 * rand())}")"
}

# Ctrl-C or SIGTERM: checkpoint, status stopped, 130; a scene of other size cannot go on from it.
for signal in INT TERM; do
  # A shell without job control starts background programs with SIGINT ignored.
  env --default-signal=INT "$program" run "$scene" $options --out $signal >stdout 2>stderr &
  pid=$!
  sleep "$(awk "BEGIN{print 0.4 * $wall}")"
  kill -$signal $pid
  code=0
  wait $pid || code=$?
  [ $code -eq 130 ] || fail "exit status $code after SIG$signal, expected 130"
  expect_status $signal stopped
  cp $signal/checkpoint.h5 before
  expect_exit 2 "$program" run "$scene" $options --set grid.cell_m=0.2 --out $signal --resume
  expect_same before $signal/checkpoint.h5
  expect_exit 0 "$program" run "$scene" $options --out $signal --resume
  expect_same whole/checkpoint.h5 $signal/checkpoint.h5
  expect_same whole/history.csv $signal/history.csv
done

# kill -9 at random moments, again and again on the same folder and each on its own.
for ((i = 1; i <= kills; i++)); do
  for out in again alone_$i; do
    "$program" run "$scene" $options --out $out --resume >stdout 2>stderr &
    pid=$!
    sleep_part
    kill -9 $pid 2>/dev/null || true
    wait $pid 2>/dev/null || true
  done
  expect_exit 0 "$program" run "$scene" $options --out alone_$i --resume
  expect_same whole/checkpoint.h5 alone_$i/checkpoint.h5
  expect_same whole/history.csv alone_$i/history.csv
done
expect_exit 0 "$program" run "$scene" $options --out again --resume
expect_status again finished
expect_same whole/checkpoint.h5 again/checkpoint.h5
expect_same whole/history.csv again/history.csv
done_checking
