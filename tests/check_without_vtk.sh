#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Built without VTK the program runs, and its summary says what is missing.
. "$(dirname "$0")/harness.sh"
scene=$scenes/small_elastic.yaml

expect_exit 0 cmake -S "$source_dir" -B plain -DCMAKE_BUILD_TYPE=Release -DPW_WITH_VTK=OFF \
  -DPW_TESTS=OFF -DCMAKE_C_FLAGS_RELEASE=-O1 -G Ninja
expect_exit 0 cmake --build plain -j2
expect_exit 0 plain/pilewright run "$scene" --set output.pictures=false --out run
expect_status run finished
expect_text run/summary.json 'libvtk9-dev'
expect_text stdout 'libvtk9-dev'
expect_absent run/paraview
done_checking
