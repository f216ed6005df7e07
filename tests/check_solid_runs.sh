#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Solid scenes run to the same bytes on any number of threads, and after being interrupted or killed;
# a step that cannot be solved ends the run with its residuals and the last good checkpoint.
# PW_KILLS: how many times to kill (2).
. "$(dirname "$0")/harness.sh"
kills=${PW_KILLS:-2}
block=$scenes/small_block.yaml
vane=$scenes/small_vane.yaml
steps='--set output.checkpoint_every_steps=1'

expect_exit 0 "$program" run "$block" --threads 1 --out whole
expect_status whole finished
for file in history.csv checkpoint.h5 paraview/run.pvd paraview/points_0001.vtp \
  paraview/mesh_0001.vtu; do
  expect_file whole/$file
done
expect_text whole/summary.json '"effects": \['
expect_text whole/summary.json '"boundary_5_force_y_n": -8'
expect_text whole/summary.json '"wall_s"'
expect_text whole/history.csv '^time_s,step,iterations,cuts,residual,equations,tests_per_point,'
grep -q 'gnuplot' whole/summary.json || expect_file whole/pictures/von_mises_stress_t08.000s.png
expect_exit 0 "$program" run "$block" $plain --threads 2 --out two
expect_same whole/checkpoint.h5 two/checkpoint.h5
expect_same whole/history.csv two/history.csv

# A step that cannot be solved: exit status 3, residuals, the checkpoint of the step before.
expect_exit 3 "$program" run "$block" $plain $steps --out failed --set implicit.max_cuts=0 \
  --set implicit.approach=0 --set implicit.max_iterations=4
expect_text stderr 'no balance between t = 0 and 1 of a load step'
expect_text stderr 'residuals: [0-9]'
expect_text stderr 'the last good checkpoint is failed/checkpoint.h5'
expect_status failed failed
expect_file failed/checkpoint.h5

# Interrupted and killed, on a mesh file when there is gmsh.
scene=$vane
grep -q '^GMSH_LIBRARY:FILEPATH=.*NOTFOUND' "$build/CMakeCache.txt" && scene=$block
expect_exit 0 "$program" run "$scene" $plain $steps --out once
rows=$(wc -l <once/history.csv)
for ((i = 0; i <= kills; i++)); do
  signal=$([ $i -eq 0 ] && echo INT || echo KILL)
  env --default-signal=INT "$program" run "$scene" $plain $steps --out again_$i >stdout 2>stderr &
  pid=$!
  until [ "$(wc -l 2>/dev/null <again_$i/history.csv || echo 0)" -ge $((2 + RANDOM % (rows - 4))) ] ||
    ! kill -0 $pid 2>/dev/null; do
    sleep 0.02
  done
  kill -$signal $pid 2>/dev/null || true
  code=0
  wait $pid 2>/dev/null || code=$?
  [ $i -gt 0 ] || [ $code -eq 130 ] || fail "exit status $code after an interrupt, expected 130"
  [ $i -gt 0 ] || expect_status again_0 stopped
  expect_exit 2 "$program" run "$scene" $plain --out again_$i --resume --set implicit.tolerance=1e-8
  expect_exit 0 "$program" run "$scene" $plain --out again_$i --resume
  expect_status again_$i finished
  expect_same once/checkpoint.h5 again_$i/checkpoint.h5
  expect_same once/history.csv again_$i/history.csv
done
done_checking
