#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The program's command line: help, exit status 1 for what it does not understand.
. "$(dirname "$0")/harness.sh"
scene=$scenes/small_elastic.yaml

expect_exit 0 "$program" --help
expect_text stdout 'run SCENE.yaml'
expect_text stdout 'Exit status'
for command in run check element keys list; do
  expect_exit 0 "$program" $command --help
  expect_text stdout "usage: pilewright $command"
  expect_exit 0 "$program" help $command
done
expect_exit 0 "$program" --version
expect_text stdout '^pilewright [0-9]+\.[0-9]+\.[0-9]+ \('
expect_exit 0 "$program" keys
for key in cell_m density_kg_m3 end_s youngs_modulus_pa acceleration_m_s2; do
  expect_text stdout "(^|[^a-z_])$key([^a-z_]|\$)"
done
expect_exit 0 "$program" list
for name in linear_elastic neo_hookean hypoplastic_sand gravity boundary cpdi; do
  expect_text stdout "$name"
done

expect_exit 1 "$program"
expect_exit 1 "$program" fly
expect_text stderr 'no such command: fly'
expect_exit 1 "$program" run
expect_text stderr 'no scene file'
expect_exit 1 "$program" run "$scene" "$scene"
expect_exit 1 "$program" run "$scene" --colour
expect_text stderr 'unknown option --colour'
expect_exit 1 "$program" run "$scene" --out
expect_text stderr 'value is missing'
expect_exit 1 "$program" check "$scene" --force
expect_text stderr 'not an option of this command'
expect_exit 1 "$program" check "$scene" --out x
expect_text stderr 'not an option of this command: --out$'
for command in run element; do
  expect_exit 1 "$program" $command -xy "$scene"
  expect_text stderr 'unknown option -x$'
done
expect_exit 1 "$program" keys everything
expect_exit 1 "$program" run "$scene" --resume --force
for threads in 0 -1 two 1.5 '' 99999999999999999999; do
  expect_exit 1 "$program" run "$scene" --threads "$threads"
done
expect_absent out

# Threads are bound when the run takes the whole machine and the user did not choose.
cores=$(env -u OMP_NUM_THREADS nproc)
if [ "$cores" -gt 1 ] && [ -r /sys/devices/system/cpu/cpu0/topology/core_id ]; then
  expect_exit 0 env -u OMP_PROC_BIND "$program" run "$scene" $plain --threads "$cores" --out bound
  expect_text stdout 'threads bound to cores'
  expect_exit 0 "$program" run "$scene" $plain --threads "$cores" --out unbound
  grep -q 'bound to cores' stdout && fail "threads were bound although OMP_PROC_BIND=false"
  expect_same bound/checkpoint.h5 unbound/checkpoint.h5
fi
done_checking
