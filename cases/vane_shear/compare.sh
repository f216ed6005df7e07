#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Vane shear with F-bar and without: two runs and one picture of both torques.
# usage: cases/vane_shear/compare.sh [OUT_FOLDER] [options of pilewright run, such as --set ...]
set -eu
here=$(cd "$(dirname "$0")" && pwd)
program=${PILEWRIGHT:-$here/../../build/pilewright}
out=${1:-out/vane_shear_compared}
shift || true
for fbar in increment none; do
  "$program" run "$here/scene.yaml" --out "$out/$fbar" --force --set implicit.fbar=$fbar "$@"
done
column() { head -n 1 "$out/increment/history.csv" | tr ',' '\n' | grep -nx "$1" | cut -d: -f1; }
angle=$(column driven_angle_deg) torque=$(column driven_torque_n_m)
gnuplot <<END
set terminal pngcairo size 1200,720 font 'DejaVu Sans,16' linewidth 1.5
set output '$out/torque.png'
set datafile separator ','
set border 3
set tics out nomirror
set key left top reverse Left
set xlabel 'angle (1e-3 rad)'
set ylabel 'torque over that of a cylinder of soil at yield'
set title 'Vane shear'
cylinder = 2*pi*0.05**2*0.05*1e4
plot for [f in 'increment none'] '$out/'.f.'/history.csv' skip 1 \
  using (\$$angle*pi/0.18):(\$$torque/cylinder) with lines \
  title (f eq 'none' ? 'without F-bar' : 'with F-bar')
END
echo "$out/torque.png"
