#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Checkpoints and histories are the same bytes for 1, 2, 3 and 4 threads.
. "$(dirname "$0")/harness.sh"

for scene in "$scenes"/small_*.yaml; do
  name=$(basename "$scene" .yaml)
  for threads in 1 2 3 4; do
    expect_exit 0 "$program" run "$scene" $plain --threads $threads --out ${name}_$threads
    expect_text ${name}_$threads/summary.json "\"threads\": $threads,"
    expect_same ${name}_1/checkpoint.h5 ${name}_$threads/checkpoint.h5
    expect_same ${name}_1/history.csv ${name}_$threads/history.csv
  done
done

# Solid scenes with either solver; the symmetric ones too, which have another factorisation.
for engine in direct krylov; do
  for fbar in none increment; do
    for threads in 1 2 3 4; do
      out=block_${engine}_$fbar
      expect_exit 0 "$program" run "$scenes/small_block.yaml" $plain --threads $threads \
        --set implicit.solver=$engine --set implicit.fbar=$fbar --set implicit.steps=4 \
        --out ${out}_$threads
      expect_same ${out}_1/checkpoint.h5 ${out}_$threads/checkpoint.h5
      expect_same ${out}_1/history.csv ${out}_$threads/history.csv
    done
  done
done

# The driven pile itself, with a short gravity stage and a blow.
pile="--set gravity.ramp_s=0.01 --set hammer.start_s=0.01 --set time.end_s=0.03"
for case in penalty frictional; do
  for threads in 1 2 3 4; do
    expect_exit 0 "$program" run "$source_dir/cases/hammered_pile/$case.yaml" $plain $pile \
      --threads $threads --out ${case}_$threads
    expect_same ${case}_1/checkpoint.h5 ${case}_$threads/checkpoint.h5
  done
done

# The same with a rod and corner contact, on a coarse grid.
coarse="--set grid.cell_m=0.125"
for threads in 1 3; do
  expect_exit 0 "$program" run "$source_dir/cases/hammered_pile/corner.yaml" $plain $pile $coarse \
    --threads $threads --out corner_$threads
  expect_same corner_1/checkpoint.h5 corner_$threads/checkpoint.h5
done
done_checking
