#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A column of every material that may start from a stress, in equilibrium with its weight and a
# surcharge at the start, stays there: no motion, and the floor carries both.
. "$(dirname "$0")/harness.sh"

# column NAME MATERIAL DENSITY: MATERIAL is the entry of a scene.
column() {
  cat >"$1.yaml" <<END
geometry: plane_strain
grid: {origin_m: [0, 0], size_m: [0.2, 2.4], cell_m: 0.1}
time: {end_s: 0.1, cfl: 0.5}
materials:
  soil: {$2}
bodies:
  soil: {material: soil, shape: rectangle, x_m: [0, 0.2], y_m: [0, 2], point_size_m: 0.05}
output: {history_every_s: 0.01, snapshot_every_s: 0.1, pictures: false, paraview: false}
gravity: {acceleration_m_s2: 10}
initial_stress: {body: soil, kind: k0, k0: 0.6, surcharge_pa: 5.0e4, top_y_m: 2}
surcharge:
  - {body: soil, side: top, pressure_pa: 5.0e4}
boundary:
  - {side: bottom, fix_y: true}
  - {side: left, fix_x: true}
  - {side: right, fix_x: true}
END
  expect_exit 0 "$program" run "$1.yaml" --quiet --threads 1 --out "$1"
  checks=$((checks + 2))
  # kinetic energy below 1e-15 J; reaction 0.2 m (50 kPa + 2 m weight) to 1e-9
  awk -F, -v weight="$3" 'NR == 1 { for (i = 1; i <= NF; i++) c[$i] = i; next } { last = $0 }
    END { split(last, v, ","); f = v[c["boundary_0_force_y_n"]]; w = 0.2 * (5e4 + weight * 20);
          exit !(v[c["kinetic_j"]] < 1e-15 && f - w < 1e-9 * w && w - f < 1e-9 * w) }' \
    "$1/history.csv" || fail "$1 does not rest: $(tail -1 "$1/history.csv")"
}

elastic="poisson_ratio: 0.3, density_kg_m3: 1800"
column linear_elastic "model: linear_elastic, youngs_modulus_pa: 1.0e7, $elastic" 1800
column hencky_von_mises "model: hencky_von_mises, youngs_modulus_pa: 1.0e7, $elastic,
    undrained_shear_strength_pa: 2.0e4, yield_gradient_pa_m: 1.0e3, reference_y_m: 2" 1800
column tresca "model: tresca, undrained_shear_strength_pa: 2.0e4, density_kg_m3: 1800,
    undrained_shear_strength_gradient_pa_m: 1.0e3, rigidity_index: 50, reference_y_m: 2" 1800
column mohr_coulomb "model: mohr_coulomb, youngs_modulus_pa: 2.0e7, $elastic,
    friction_angle_deg: 30, cohesion_pa: 1.0e3, tension_cutoff: true" 1800
column drucker_prager "model: drucker_prager, youngs_modulus_pa: 2.0e7, $elastic,
    friction_angle_deg: 30, cohesion_pa: 1.0e3" 1800
column modified_cam_clay "model: modified_cam_clay, compression_index_lambda: 0.2, $elastic,
    swelling_index_kappa: 0.04, critical_stress_ratio: 1, void_ratio: 1.1,
    overconsolidation_ratio: 1.5" 1800
mkdir soils
cp "$source_dir"/cases/soils/*.yaml soils/
column london_clay "soil: london_clay, overconsolidation_ratio: 2, density_kg_m3: 1800" 1800
column kaolin_clay "soil: kaolin_clay" 1800
for sand in thesis_sand karlsruhe_sand hochstetten_sand; do
  column $sand "soil: $sand, grain_density_kg_m3: 3060, void_ratio: 0.7" 1800
done

# Without surcharge the uppermost points stand below 1 kPa: a least pressure above that would throw
# them off. Nothing moves in a second.
bare() {
  sed "0,/^  soil: {.*/s//  soil: {$2}/; /^surcharge:/,/body: soil, side: top/d; s/, surcharge_pa: 5.0e4//
    s/end_s: 0.1/end_s: 1/; s/snapshot_every_s: 0.1/snapshot_every_s: 1/" thesis_sand.yaml >"bare_$1.yaml"
  expect_exit 0 "$program" run "bare_$1.yaml" --quiet --threads 1 --out "bare_$1"
  checks=$((checks + 1))
  awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) c[$i] = i; next } { last = $0 }
    END { split(last, v, ","); exit !(v[c["kinetic_j"]] < 1e-12) }' "bare_$1/history.csv" ||
    fail "bare $1 does not rest: $(tail -1 "bare_$1/history.csv")"
}
bare london_clay "soil: london_clay, overconsolidation_ratio: 4"
bare kaolin_clay "soil: kaolin_clay"
bare cam_clay "model: modified_cam_clay, compression_index_lambda: 0.2, $elastic, swelling_index_kappa: 0.04, critical_stress_ratio: 1, void_ratio: 1.1, overconsolidation_ratio: 1.5"
done_checking
