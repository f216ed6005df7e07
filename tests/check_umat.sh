#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The example UMAT in Fortran: built, run in an element test and in a scene on 1 and 2 threads, held
# against built-in models; wrong entries have their place, STOP ends a run and not the program.
. "$(dirname "$0")/harness.sh"
command -v gfortran >/dev/null || { echo "skipped: no gfortran"; exit 77; }
cp "$source_dir"/cases/umat_von_mises/* .
gfortran -O2 -fPIC -shared -frecursive -o umat_von_mises.so umat_von_mises.f90
quiet="--set output.pictures=false --set output.paraview=false"

# same_figures FILE FILE TOLERANCE COLUMNS...: relative to the largest figure of each column
same_figures() {
  checks=$((checks + 1))
  awk -F, -v tolerance="$3" -v columns="${*:4}" '
    FNR == 1 { file++; for (i = 1; i <= NF; i++) at[file, $i] = i; n = split(columns, name, " "); next }
    { for (k = 1; k <= n; k++) {
        x = $at[file, name[k]]
        if (x == "") exit bad = 1
        if (file == 1) { first[FNR, k] = x; size[k] = (x < 0 ? -x : x) > size[k] ? (x < 0 ? -x : x) : size[k] }
        else { d = first[FNR, k] - x; d = d < 0 ? -d : d; if (!(d <= tolerance * size[k])) bad = 1; rows++ }
      } }
    END { exit bad || rows == 0 }' "$1" "$2" || fail "$1 and $2 differ by more than $3: ${*:4}"
}

# Hardening, against the built-in model where both are the same.
sed '/library:/,/thread_safe:/d; s/model: umat/model: hencky_von_mises\n    youngs_modulus_pa: 1.0e7\
    poisson_ratio: 0.3\n    density_kg_m3: 1800\n    yield_uniaxial_pa: 5.0e4\
    hardening_modulus_pa: 5.0e5/' element.yaml >built_in.yaml
expect_exit 0 "$program" element element.yaml --set element.pictures=false --out user
expect_exit 0 "$program" element built_in.yaml --set element.pictures=false --out own
same_figures user/element.csv own/element.csv 1e-10 sigma_xx_pa sigma_yy_pa sigma_zz_pa eps_xx \
  excess_pore_pressure_pa

# Explicit steps: perfect plasticity, on 1 and 2 threads, with the library's lock and without.
sed '/library:/,/stiffness_bound_pa:/d; s/model: umat/model: drucker_prager\n    youngs_modulus_pa: 1.0e6\
    poisson_ratio: 0.3\n    density_kg_m3: 1800\n    friction_angle_deg: 0\
    cohesion_pa: 5.0e3/' scene.yaml >scene_own.yaml
for run in "one 1 true" "two 2 true" "locked 2 false"; do
  set -- $run
  expect_exit 0 "$program" run scene.yaml $quiet --set materials.clay.thread_safe=$3 --quiet \
    --set time.dt_s=1.0e-3 --threads $2 --out $1
done
expect_same one/history.csv two/history.csv
expect_same one/history.csv locked/history.csv
expect_exit 0 "$program" run scene_own.yaml $quiet --quiet --set time.dt_s=1.0e-3 --threads 1 --out own_scene
same_figures one/history.csv own_scene/history.csv 1e-8 kinetic_j strain_work_j block_x_m block_y_m

# Implicit steps: the routine in logarithmic strain against hencky_von_mises, that in rate form
# against drucker_prager without friction, each on 1 and 2 threads.
implicit() {
  expect_exit 0 "$program" run "$1.yaml" $quiet --quiet --threads "$2" --out "$3"
}
figures="boundary_1_force_x_n boundary_1_force_y_n stress_record_0_mean_pa stress_record_0_least_pa
  stress_record_1_mean_pa stress_record_1_largest_pa"
sed '/library:/,/thread_safe:/d; s/model: umat/model: hencky_von_mises\n    youngs_modulus_pa: 1.0e7\
    poisson_ratio: 0.3\n    density_kg_m3: 1800\n    yield_uniaxial_pa: 5.0e4\
    hardening_modulus_pa: 5.0e5/' implicit.yaml >implicit_own.yaml
sed '/symbol:/d; /ddsdde_measure:/d; s/nstatv: 7/nstatv: 1/; s/, 5.0e5\]/, 0]/' implicit.yaml >rate.yaml
sed '/library:/,/thread_safe:/d; s/model: umat/model: drucker_prager\n    youngs_modulus_pa: 1.0e7\
    poisson_ratio: 0.3\n    density_kg_m3: 1800\n    friction_angle_deg: 0\
    cohesion_pa: 2.5e4/' implicit.yaml >rate_own.yaml
for run in "implicit implicit_own" "rate rate_own"; do
  set -- $run
  implicit "$1" 1 "$1"
  implicit "$1" 2 "$1"_two
  implicit "$2" 1 "$2"
  expect_same "$1"/history.csv "$1"_two/history.csv
  same_figures "$1"/history.csv "$2"/history.csv 1e-10 $figures
done
sed 's/nstatv: 7/nstatv: 6/' implicit.yaml >stop_implicit.yaml
expect_exit 3 "$program" run stop_implicit.yaml $quiet --out stop_implicit
expect_text stderr 'in element [0-9]*: the UMAT ended with STOP: umat_hencky needs 4 constants'

# A run that is stopped and resumed from another folder finds the library and goes on.
expect_exit 0 "$program" run scene.yaml $quiet --quiet --threads 1 --out half --set time.dt_s=1.0e-3 \
  --set output.checkpoint_every_s=0.05 --set time.end_s=0.1
mkdir elsewhere
(cd elsewhere && expect_exit 0 "$program" run ../scene.yaml $quiet --quiet --threads 1 --out ../half \
  --set time.dt_s=1.0e-3 --set output.checkpoint_every_s=0.05 --resume)
expect_same one/history.csv half/history.csv

# From --set the library is one of the working folder.
(cd elsewhere && expect_exit 2 "$program" element ../element.yaml --out ../set \
  --set materials.clay.library=umat_von_mises.so)
expect_text stderr '--set materials.clay.library=.*: error: library: there is no file umat_von_mises.so'
expect_exit 0 "$program" element element.yaml --out set --set element.pictures=false \
  --set materials.clay.library="$work/umat_von_mises.so"
# A soil's file names its library beside itself.
mkdir soils
sed -n '/^    model:/,/thread_safe:/s/^    //p' element.yaml | sed 's/library: /library: ..\//' >soils/users.yaml
echo 'source: cases/umat_von_mises' >>soils/users.yaml
sed '/^    model:/,/thread_safe:/d; s/^  clay:/  clay: {soil: users}/' element.yaml >soil.yaml
expect_exit 0 "$program" element soil.yaml --set element.pictures=false --out soil
expect_same soil/element.csv user/element.csv

# Wrong entries: their place and the rule.
wrong() {
  sed "$1" element.yaml >wrong.yaml
  expect_exit 2 "$program" element wrong.yaml --out wrong
  expect_text stderr "$2"
  expect_absent wrong
}
wrong 's/umat_von_mises.so /nowhere.so /' 'wrong.yaml:8:14: error: library: there is no file nowhere.so'
wrong 's/umat_von_mises.so /umat_von_mises.f90 /' 'wrong.yaml:8:14: error: library: cannot load it'
wrong 's/density_kg_m3: 1800/&\n    symbol: umat_clay/' \
  'wrong.yaml:10:13: error: symbol: there is no routine umat_clay'
wrong 's/nprops: 4/nprops: 5/' 'wrong.yaml:11:12: error: props holds 4 numbers, but nprops = 5'
wrong '/nprops: 4/d' "wrong.yaml:6:3: error: missing key 'nprops'"

# STOP: the routine wants four constants.
sed 's/nprops: 4/nprops: 3/; s/, 5.0e5\]/]/' element.yaml >stop.yaml
expect_exit 3 "$program" element stop.yaml --out stop
expect_text stderr 'stage 1, step 1: the UMAT ended with STOP: umat_von_mises needs 4 constants'
expect_exit 3 "$program" run scene.yaml $quiet --set materials.clay.nstatv=2 --out stop_scene
expect_text stderr 'the UMAT ended with STOP: umat_von_mises needs 4 constants .*material clay'

done_checking
