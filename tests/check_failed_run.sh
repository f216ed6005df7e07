#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A run that fails stops at once with exit status 3, says where and when, and leaves its last good
# checkpoint, from which it can be looked at again.
. "$(dirname "$0")/harness.sh"
scene=$scenes/small_elastic.yaml

# The block is thrown out of the grid.
options="$plain --set bodies.block.velocity_m_s=[0,50] --set output.checkpoint_every_s=0.002"
expect_exit 3 "$program" run "$scene" $options --out lost
expect_status lost failed
for text in 'point [0-9]+' 'block' 'step [0-9]+' 'time [0-9.e-]+ s' '\([-0-9.e]+, [-0-9.e]+\) m'; do
  expect_text stderr "$text"
done
expect_text stderr 'last good checkpoint is lost/checkpoint.h5'
expect_text lost/summary.json '"error": ".*point [0-9]+'
expect_file lost/checkpoint.h5
tail -n 1 stdout | grep -q '^failed at t = ' || fail "no last line about the failure"

# Going on from it fails in the same way.
cp -r lost again
expect_exit 3 "$program" run "$scene" $options --out again --resume
expect_same lost/history.csv again/history.csv
expect_same lost/checkpoint.h5 again/checkpoint.h5

# A wave that no step can follow: a fixed step far beyond the stable one.
expect_exit 3 "$program" run "$scene" $plain --out wild --set time.dt_s=0.02 --set time.end_s=40 \
  --set bodies.block.velocity_m_s=[1,1]
expect_status wild failed
expect_text stderr '(unstable|point [0-9]+).*step [0-9]+'
grep -qi 'nan' wild/history.csv && fail "NaN in the history of a failed run"
done_checking
