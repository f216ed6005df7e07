#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Scenes with implicit steps on the grid run to the same bytes on any number of threads, and after
# being interrupted or killed; a step that cannot be solved ends the run with its residuals; what
# such steps do not know is refused at its place.
# PW_KILLS: how many times to kill (2).
. "$(dirname "$0")/harness.sh"
kills=${PW_KILLS:-2}
slump=$scenes/small_slump.yaml

expect_exit 0 "$program" run "$slump" --threads 1 --out whole
expect_status whole finished
for file in history.csv checkpoint.h5 paraview/run.pvd paraview/points_0001.vtp; do
  expect_file whole/$file
done
expect_text whole/history.csv '^time_s,step,.*,iterations,cuts,residual,equations,'
expect_text whole/summary.json '"iterations": [0-9]'
grep -q 'gnuplot' whole/summary.json || expect_file whole/pictures/vertical_stress_t01.000s.png
expect_exit 0 "$program" run "$slump" $plain --threads 2 --out two
expect_same whole/checkpoint.h5 two/checkpoint.h5
expect_same whole/history.csv two/history.csv

expect_exit 0 "$program" check "$slump"
expect_text stdout '^load steps   40 of 0.025 s each'
expect_text stdout '^equations    [0-9]+, [0-9]+ values in a matrix that is symmetric'

# A step that cannot be solved: exit status 3, residuals, the checkpoint of the step before.
expect_exit 3 "$program" run "$slump" $plain --out failed --set implicit.max_cuts=0 \
  --set implicit.approach=0 --set implicit.max_iterations=2
expect_text stderr 'no balance between t = 0 and 1 of a load step'
expect_text stderr 'residuals: [0-9]'
expect_status failed failed

# Loads of nodes that hardly have material would be lost: told where there are nodes left out.
expect_exit 3 "$program" run "$slump" $plain --out light --set method.mass_cut_off=0.05
expect_text stderr '[0-9] of [0-9.e+]+ N of load act on nodes that method.mass_cut_off leaves out'

# What implicit steps do not know, and what explicit ones do not.
expect_refused() {
  text=$1
  shift
  expect_exit 2 "$program" check "$@"
  expect_text stderr "$text"
}
sed 's/^gravity.*/&\nhammer: {body: block, pressure_pa: 1, duration_s: 1}/' "$slump" >hammer.yaml
expect_refused 'hammer.yaml:13:[0-9]+: error: hammer: implicit steps .* with dynamics only' hammer.yaml
sed 's/^gravity.*/&\nfbar: {}/' "$slump" >fbar.yaml
expect_refused 'fbar.yaml:13:[0-9]+: error: fbar: implicit steps .* do not know' fbar.yaml
sed 's/point_size_m: 0.0625/&, velocity_m_s: [1, 0]/' "$slump" >moving.yaml
expect_refused 'moving.yaml:11:[0-9]+: error: velocity_m_s: implicit steps' moving.yaml
sed '/^implicit/d; /^ghost/d; s/update: implicit/update: musl/' "$slump" >explicit.yaml
expect_exit 0 "$program" check explicit.yaml
sed '/^ghost/d; s/update: implicit/update: musl/' "$slump" >section.yaml
expect_refused 'section.yaml:7:[0-9]+: error: implicit: explicit steps' section.yaml
sed '/^implicit/d; s/update: implicit/update: musl/' "$slump" >ghost.yaml
expect_refused 'ghost.yaml:12:[0-9]+: error: explicit steps know no stabilisation' ghost.yaml
sed 's/point_size_m: 0.0625/&, velocity_m_s: [1, 0]/; s/^gravity.*/&\ndynamics: {}/' "$slump" >free.yaml
expect_exit 0 "$program" check free.yaml
sed 's/^gravity.*/&\ndynamics: {}\ndamping_local: [{coefficient: 0.1}]/' "$slump" >damped.yaml
expect_refused 'damped.yaml:14:[0-9]+: error: implicit steps know it in equilibrium' damped.yaml
sed 's/^gravity.*/&\ndynamics: {mass: consistent}/' "$slump" >mass.yaml
expect_refused 'mass.yaml:13:18: error: mass: on a grid masses are lumped' mass.yaml
expect_refused 'dt_s: implicit steps .* = 0.025 s' "$slump" --set time.dt_s=0.01
expect_refused 'noise_damping_per_s: implicit steps' "$slump" --set method.noise_damping_per_s=1
expect_refused 'implicit.fbar.*' "$slump" --set implicit.fbar=none

# Interrupted and killed, with inertia.
slump=free.yaml
expect_exit 0 "$program" run "$slump" $plain --out once
rows=$(wc -l <once/history.csv)
for ((i = 0; i <= kills; i++)); do
  signal=$([ $i -eq 0 ] && echo INT || echo KILL)
  env --default-signal=INT "$program" run "$slump" $plain --out again_$i >stdout 2>stderr &
  pid=$!
  until [ "$(wc -l 2>/dev/null <again_$i/history.csv || echo 0)" -ge $((4 + RANDOM % (rows / 2))) ] ||
    ! kill -0 $pid 2>/dev/null; do
    sleep 0.01
  done
  kill -$signal $pid 2>/dev/null || true
  code=0
  wait $pid 2>/dev/null || code=$?
  [ $i -gt 0 ] || [ $code -eq 130 ] || fail "exit status $code after an interrupt, expected 130"
  [ $i -gt 0 ] || expect_status again_0 stopped
  expect_exit 2 "$program" run "$slump" $plain --out again_$i --resume --set implicit.tolerance=1e-8
  expect_exit 0 "$program" run "$slump" $plain --out again_$i --resume
  expect_status again_$i finished
  expect_same once/checkpoint.h5 again_$i/checkpoint.h5
  expect_same once/history.csv again_$i/history.csv
done
done_checking
