#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# `pilewright element`: every case runs, known figures come out, errors have places and exit codes.
. "$(dirname "$0")/harness.sh"
cases=$source_dir/cases/element_tests

# column FILE NAME: its values, one a line.
column() {
  awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) c = i; next }
    { print $c }' "$1"
}

# expect_value GOT WANTED TOLERANCE
expect_value() {
  checks=$((checks + 1))
  awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN { d = a - b; exit !(a != "" && d <= t && -d <= t) }' ||
    fail "$1 is not $2 within $3"
}

for file in "$cases"/*.yaml; do
  name=$(basename "$file" .yaml)
  expect_exit 0 "$program" element "$file" --set element.pictures=false --out "$name"
  expect_file "$name/element.csv"
done

# Undrained strength of modified Cam clay: p = 100 kPa (1/2)^0.8, q = M p.
expect_value "$(column triaxial_clay/element.csv mean_pressure_pa | tail -1)" 57434.92 1
expect_value "$(column triaxial_clay/element.csv deviator_q_pa | tail -1)" 57434.92 1
# Biaxial test of the reference: peak 309.1 kPa at 2.87 % (tests/reference/hypoplastic/README.md).
peak=$(column biaxial_sand/element.csv lateral_minus_axial_pa | sort -g | tail -1)
expect_value "$peak" 309132 30
# Oedometer: no lateral strain, the axial stress as asked for.
expect_value "$(column oedometer_sand/element.csv eps_xx | sort -g | head -1)" 0 0
expect_value "$(column oedometer_sand/element.csv sigma_yy_pa | tail -1)" -800000 0.1
# Undrained: no change of volume; the axial total stress goes to and fro as asked for.
expect_value "$(column cyclic_sand/element.csv eps_vol | sort -g | tail -1)" 0 1e-12
expect_value "$(paste -d' ' <(column cyclic_sand/element.csv sigma_yy_pa) \
  <(column cyclic_sand/element.csv excess_pore_pressure_pa) | awk 'NR == 41 { print $1 - $2 }')" \
  -130000 1
# Clay of 32 kPa at 8 m: simple shear beyond it.
expect_value "$(column shear_clay/element.csv sigma_xy_pa | tail -1)" 32008 5
strain=$(column mohr_coulomb_mixed/element.csv eps_yy)
expect_value "$(echo "$strain" | tail -1)" \
  "$(echo "$strain" | awk 'NR == 401 { printf "%.15g", $1 - 0.002 }')" 1e-12

# Curves in both formats, whole files.
if command -v gnuplot >/dev/null; then
  expect_exit 0 "$program" element "$cases/triaxial_clay.yaml" --out curves
  for curve in q_p q_strain e_log_p volume; do
    expect_file "curves/pictures/$curve.png"
    expect_text "curves/pictures/$curve.svg" '</svg>'
  done
fi

# The same bits each time.
expect_exit 0 "$program" element "$cases/cyclic_sand.yaml" --set element.pictures=false --out again
expect_same again/element.csv cyclic_sand/element.csv

# All errors at once, with their places; nothing is written.
cat >bad.yaml <<'END'
materials:
  clay: {soil: no_such_soil}
  soil:
    model: mohr_coulomb
    youngs_modulus_pa: 1e7
    poisson_ratio: 0.3
    density_kg_m3: 1800
    friction_angle_deg: 0
element: {material: soil, initial_stress_pa: [-1, 2]}
stages:
  - {kind: triaxal, to_strain: [-0.1]}
  - {kind: triaxial}
END
expect_exit 2 "$program" element bad.yaml
expect_text stderr 'bad.yaml:2:16: error: .*no_such_soil'
expect_text stderr 'bad.yaml:8:25: error: friction_angle_deg = 0 needs a cohesion_pa'
expect_text stderr 'bad.yaml:9:46: error: initial_stress_pa'
expect_text stderr "bad.yaml:11:12: error: .*did you mean 'triaxial'"
expect_text stderr 'bad.yaml:12:12: error: a stage needs turning points'
expect_absent out

# An error in a soil's file has that file's name and line.
mkdir soils
sed 's/exponent_n: 0.28/exponent_n: 1.28/' \
  "$source_dir/cases/soils/thesis_sand.yaml" >soils/odd.yaml
cat >odd.yaml <<'END'
materials:
  sand: {soil: odd}
element: {material: sand, initial_stress_pa: [-1.0e5]}
stages:
  - {kind: isotropic, to_strain: [-0.01]}
END
expect_exit 2 "$program" element odd.yaml
expect_text stderr 'soils/odd.yaml:[0-9]+:13: error: .exponent_n. = 1.28 is out of range'
expect_exit 0 "$program" element odd.yaml --set materials.sand.exponent_n=0.3 \
  --set element.pictures=false

# A stress beyond the strength: exit status 3, stage and step, and the rows before it.
cat >strong.yaml <<'END'
materials:
  clay:
    {model: tresca, undrained_shear_strength_pa: 1.0e4, rigidity_index: 100, density_kg_m3: 1800}
element: {material: clay, initial_stress_pa: [-1.0e5]}
stages:
  - {kind: triaxial, to_stress_pa: [-1.5e5], steps: 10}
END
expect_exit 3 "$program" element strong.yaml --out strong
expect_text stderr 'stage 1, step 5 cannot be made'
expect_text strong/element.csv '^1,4,'

sed 's/path.csv/nowhere.csv/' "$cases/mohr_coulomb_mixed.yaml" >path.yaml
expect_exit 2 "$program" element path.yaml
expect_text stderr 'nowhere.csv'
echo '# nothing' >empty.yaml
expect_exit 2 "$program" element empty.yaml
expect_text stderr 'the file is empty: a test needs at least materials, element and stages'
echo >file
expect_exit 3 "$program" element "$cases/mohr_coulomb_mixed.yaml" --out file/below
expect_exit 1 "$program" element
expect_exit 1 "$program" element odd.yaml --colour
expect_exit 0 "$program" element --keys
expect_text stdout 'to_stress_pa'
expect_exit 0 "$program" element --help

done_checking
