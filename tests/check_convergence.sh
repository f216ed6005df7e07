#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The mesh study in small: a row for each run, no run twice, the time left, a clean end where a scene
# is refused.
. "$(dirname "$0")/harness.sh"
study="python3 $source_dir/cases/pile_convergence/converge.py"
small="--program $program --threads 1 --resolutions 1.2 --end 0.01 --set output.pictures=false --set output.paraview=false"

expect_exit 0 $study push $small --out push
expect_text stdout '^run: corner radius/cell 1.2: '
expect_text stdout '^run: frictional radius/cell 1.2, less than a minute left: '
for contact in corner penalty frictional; do
  expect_text push/table.csv "^$contact,1.2,finished,"
done
expect_exit 0 $study push $small --out push
grep -q '^run:' stdout && fail "runs that had ended were repeated"

expect_exit 0 $study hammer $small --contacts corner --out hammer
expect_text hammer/table.csv '^corner,1.2,finished,'

expect_exit 1 $study push $small --contacts corner --set grid.cell_m=0.08 --out refused
expect_text stderr 'refused at radius/cell 1.2'
done_checking
