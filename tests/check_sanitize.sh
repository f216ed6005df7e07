#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Memory, undefined behaviour and races: a few steps of small scenes under the sanitizers.
set -eu
export PW_STEPS=${PW_STEPS:-300}
scenes=("$2"/tests/scenes/small_*.yaml)
PW_BUILD=$1/address "$2/tests/sanitize" address "${scenes[@]}"
command -v clang-14 >/dev/null || { echo "skipped: no clang-14"; exit 77; }
PW_BUILD=$1/thread "$2/tests/sanitize" thread "${scenes[@]}"
