#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# No room or no permission to write: exit status 3, a clear message, the last checkpoint whole.
. "$(dirname "$0")/harness.sh"
scene=$scenes/small_elastic.yaml

# A file size limit (in KiB) that the history reaches after the first checkpoint.
expect_exit 0 "$program" run "$scene" $plain --out measure
size=$(($(stat -c %s measure/checkpoint.h5) / 1024 + 2))
limited() { (ulimit -f $size && exec "$@"); }
expect_exit 3 limited "$program" run "$scene" $plain --out limited --set time.end_s=4 \
  --set output.history_every_s=0 --set output.checkpoint_every_s=0.1
expect_text stderr 'history.csv: '
expect_text stderr 'last good checkpoint'
expect_file limited/checkpoint.h5
expect_status limited failed
# With room again it goes on, to the same bytes as a run that never met the limit.
long="--set time.end_s=4 --set output.history_every_s=0"
expect_exit 0 "$program" run "$scene" $plain $long --out limited --resume
expect_exit 0 "$program" run "$scene" $plain $long --out whole
expect_same whole/checkpoint.h5 limited/checkpoint.h5
expect_same whole/history.csv limited/history.csv

# No room for any checkpoint.
size=8
expect_exit 3 limited "$program" run "$scene" $plain --out tiny
expect_text stderr 'checkpoint.h5'

# A disk that is really full, where a small one may be mounted.
mkdir disk
if mount -t tmpfs -o size=300k tmpfs disk 2>/dev/null; then
  expect_exit 3 "$program" run "$scene" $plain $long --out disk/run
  expect_text stderr 'No space left'
  cp -r disk/run rescued
  umount disk
  expect_exit 0 "$program" run "$scene" $plain $long --out rescued --resume
  expect_same whole/checkpoint.h5 rescued/checkpoint.h5
else
  echo "note: no small disk could be mounted here"
fi

# Folders that cannot be made.
echo text >file
expect_exit 3 "$program" run "$scene" $plain --out file/run
expect_text stderr 'file/run'
mkdir locked
chmod a-w locked
if [ "$(id -u)" -ne 0 ]; then
  expect_exit 3 "$program" run "$scene" $plain --out locked/run
  expect_text stderr 'locked/run'
else
  # Root may write anywhere: become nobody, where nobody may reach the program.
  chmod a+rx "$work"
  as_nobody() { setpriv --reuid=65534 --regid=65534 --clear-groups "$@"; }
  if as_nobody "$program" --version >/dev/null 2>&1; then
    expect_exit 3 as_nobody "$program" run "$scene" $plain --out locked/run
    expect_text stderr 'locked/run'
  fi
fi
done_checking
