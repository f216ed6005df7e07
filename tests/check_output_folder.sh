#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What a run writes, and that a folder which holds a run is protected.
. "$(dirname "$0")/harness.sh"
scene=$scenes/small_elastic.yaml

expect_exit 0 "$program" run "$scene"
run=out/small_elastic
expect_status $run finished
for file in history.csv checkpoint.h5; do
  expect_file $run/$file
done
expect_text $run/history.csv '^time_s,step,'
# Rows at 0, 0.01, ..., 0.2 s exactly, and the line of names.
rows=$(wc -l <$run/history.csv)
[ "$rows" -eq 22 ] || fail "$rows lines in history.csv, expected 22"
expect_text $run/history.csv '^0\.13,'
expect_text $run/history.csv '^0\.2,'
ls $run/pictures/*.png >/dev/null || fail "no pictures"
if grep -q 'PW_VTK_FOUND:INTERNAL=ON' "$build/CMakeCache.txt"; then
  expect_file $run/paraview/run.pvd
else
  expect_text $run/summary.json 'libvtk9-dev'
fi

cp $run/summary.json summary.before
cp $run/checkpoint.h5 checkpoint.before
expect_exit 1 "$program" run "$scene"
expect_text stderr 'holds a run already'
expect_same $run/summary.json summary.before
expect_same $run/checkpoint.h5 checkpoint.before

# Resuming what is finished changes nothing; --force starts over and leaves no old pictures.
expect_exit 0 "$program" run "$scene" --resume
expect_same $run/summary.json summary.before
expect_same $run/checkpoint.h5 checkpoint.before
touch $run/pictures/old.png $run/notes.txt
expect_exit 0 "$program" run "$scene" --force
expect_absent $run/pictures/old.png
[ -e $run/notes.txt ] || fail "--force removed a file that is not a run's"
expect_same $run/checkpoint.h5 checkpoint.before

# Two runs do not write to one folder at the same time.
"$program" run "$scene" $plain --set time.end_s=1000 --out busy >/dev/null 2>&1 &
pid=$!
for ((i = 0; i < 200; i++)); do
  [ -e busy/checkpoint.h5 ] && break
  sleep 0.05
done
for mode in --resume --force; do
  expect_exit 1 timeout 20 "$program" run "$scene" $plain --set time.end_s=1000 --out busy $mode
  expect_text stderr 'another run is at work in busy'
done
kill -9 $pid
wait $pid 2>/dev/null || true
expect_exit 0 "$program" run "$scene" $plain --out busy --force

# A file called scene.yaml gives its folder's name.
mkdir my_case
cp "$scene" my_case/scene.yaml
expect_exit 0 "$program" run my_case/scene.yaml $plain --quiet
expect_status out/my_case finished
[ "$(wc -l <stdout)" -eq 1 ] || fail "--quiet printed more than its last line"

# Switching outputs off changes no number of the run.
expect_same out/my_case/checkpoint.h5 checkpoint.before
expect_exit 0 "$program" check "$scene"
for text in 'gravity' 'boundary' 'bytes' 'points +400' 'colours' 'first step' 'memory' 'time'; do
  expect_text stdout "$text"
done
done_checking
