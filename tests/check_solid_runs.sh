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

# Starting over removes what the run before has left.
expect_exit 0 "$program" run "$block" --out whole --force --set output.paraview=false
expect_absent whole/paraview/mesh_0001.vtu
expect_absent whole/paraview/run.pvd

# A column under a dead load is pressed by its weight out of the elements that are loaded.
cat >dead.yaml <<'end'
geometry: solid
mesh: {kind: box, low_m: [0, 0, 0], high_m: [1, 1, 1], bricks: [1, 1, 4], cells: linear}
implicit: {steps: 20, fbar: none, point_rule: four}
materials:
  soft: {model: hencky_von_mises, youngs_modulus_pa: 1.0e5, poisson_ratio: 0.0,
         density_kg_m3: 1000, undrained_shear_strength_pa: 1.0e9}
bodies:
  block: {material: soft}
boundary:
  - {low_m: [0, 0, 0], high_m: [1, 1, 1], fix_x: true, fix_y: true}
  - {group: z_min, fix_z: true}
traction:
  - {group: z_max, kind: pressure, pressure_pa: 4.0e4}
output: {pictures: false, paraview: false, picture_steps: [30]}
end
expect_exit 3 "$program" run dead.yaml --out dead
expect_text stderr '[0-9] of [0-9.e+]+ N of load act on nodes without points'
expect_exit 0 "$program" run dead.yaml --out follows --set traction.0.follower=true \
  --set implicit.steps=4 --set output.pictures=true
expect_text stdout '^warning: no picture at 30 s: the run ends at 4 s'
expect_text follows/summary.json 'no picture at 30 s'

# A wall that goes further than an element on a mesh that stays.
wall='--set implicit.steps=2 --set traction.0.pressure_pa=0 --set boundary.1.displacement_m=[0,0,-0.3]'
expect_exit 0 "$program" check dead.yaml $wall
expect_text stdout '^warning: boundary.1.displacement_m: 0.3 m along z on a mesh that stays'
expect_exit 0 "$program" check dead.yaml $wall --set 'moving_mesh={with: stretch, stretch_end: [1, 1, 0.7]}'
grep -q 'mesh that stays' stdout && fail "a warning of a mesh that stays although it moves"

# A body that nothing holds is told of, whether or not its steps converge.
sed '/^boundary/,/^traction/{/^traction/!d}' dead.yaml >free.yaml
expect_exit 3 "$program" run free.yaml --out free --set implicit.max_cuts=1
expect_text stderr '^warning: step 1: 1 of 1 pieces of the body, 24 elements, are held by nothing'
expect_text free/summary.json '1 of 1 pieces of the body'
expect_exit 0 "$program" check free.yaml
expect_text stdout '^warning: 1 of 1 pieces of the body'
expect_exit 2 "$program" check free.yaml --set implicit.mechanisms=error
expect_text stderr 'implicit.mechanisms: 1 of 1 pieces'
grep -q 'can be run' stdout && fail "a body that nothing holds can be run"

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
