#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A run that was interrupted or killed goes on to the same bytes as one that was not.
# PW_KILLS: how many times to kill (10); PW_SCENE: another scene (absolute path), to PW_END_S with
# checkpoints every PW_CHECKPOINT_S of simulated time.
. "$(dirname "$0")/harness.sh"
scene=${PW_SCENE:-$scenes/small_penalty.yaml}
kills=${PW_KILLS:-10}
options="$plain --threads 2 --set time.end_s=${PW_END_S:-0.4}"
options="$options --set output.checkpoint_every_s=${PW_CHECKPOINT_S:-0.01}"

expect_exit 0 "$program" run "$scene" $options --out whole
expect_status whole finished
rows=$(wc -l <whole/history.csv)

# wait_for PERCENT FOLDER PID: until the run in FOLDER has got so far, or has ended.
wait_for() {
  while [ "$(wc -l 2>/dev/null <"$2/history.csv" || echo 0)" -lt $((rows * $1 / 100)) ]; do
    kill -0 "$3" 2>/dev/null || return 0
    sleep 0.01
  done
}

# Ctrl-C or SIGTERM: checkpoint, status stopped, 130; another scene cannot go on from it.
for signal in INT TERM; do
  # A shell without job control starts background programs with SIGINT ignored.
  env --default-signal=INT "$program" run "$scene" $options --out $signal >stdout 2>stderr &
  pid=$!
  wait_for 40 $signal $pid
  kill -$signal $pid
  code=0
  wait $pid || code=$?
  [ $code -eq 130 ] || fail "exit status $code after SIG$signal, expected 130"
  expect_status $signal stopped
  cp $signal/checkpoint.h5 before
  expect_exit 2 "$program" run "$scene" $options --set method.block_elements=1 --out $signal --resume
  expect_same before $signal/checkpoint.h5
  expect_exit 2 "$program" run "$scene" $options --set gravity.acceleration_m_s2=5 --out $signal --resume
  expect_same before $signal/checkpoint.h5
  expect_exit 0 "$program" run "$scene" $options --out $signal --resume
  expect_same whole/checkpoint.h5 $signal/checkpoint.h5
  expect_same whole/history.csv $signal/history.csv
done

# kill -9 at random moments: once on a folder of its own, and again and again on one folder.
for ((i = 1; i <= kills; i++)); do
  for out in alone_$i again; do
    from=$([ $out = again ] && echo $((100 * (i - 1) / kills)) || echo 0)
    "$program" run "$scene" $options --out $out --resume >stdout 2>stderr &
    pid=$!
    wait_for $((from + RANDOM % (95 - from))) $out $pid
    sleep 0.0$((RANDOM % 10))
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

# Corner contact, a rod, absorbing sides, F-bar and reshaped domains keep more than that.
if [ -z "${PW_SCENE:-}" ]; then
  PW_SCENE=$scenes/small_corner.yaml PW_KILLS=1 PW_END_S=0.04 PW_CHECKPOINT_S=0.002 \
    "$source_dir/tests/check_resume.sh" "$build" "$source_dir" || fail "small_corner.yaml"
fi
done_checking
