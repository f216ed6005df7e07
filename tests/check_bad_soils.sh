#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Parameters of soils that break a rule, in a scene and in an element test: exit status 2, the place
# and the rule. Friction of zero with cohesion is a soil like others.
. "$(dirname "$0")/harness.sh"

# write NAME MATERIAL: an element test of it; the material begins in line 3.
write() {
  cat >"$1.yaml" <<END
materials:
  soil:
$2
element: {material: soil, initial_stress_pa: [-1.0e5]}
stages:
  - {kind: triaxial, drained: false, to_strain: [-0.05], steps: 50}
END
}
sand="    model: hypoplastic_sand
    grain_density_kg_m3: 2600
    void_ratio: 0.65
    critical_friction_angle_deg: 30
    granular_hardness_pa: 5.8e9
    exponent_n: 0.28
    void_ratio_d0: 0.53
    void_ratio_c0: 0.84
    void_ratio_i0: 1.0
    exponent_alpha: 0.13
    exponent_beta: 1.0"
coulomb="    model: mohr_coulomb
    youngs_modulus_pa: 1.0e7
    poisson_ratio: 0.3
    density_kg_m3: 1800
    friction_angle_deg: 30
    cohesion_pa: 0"

# bad NAME MATERIAL REGEX
bad() {
  write "$1" "$2"
  expect_exit 2 "$program" element "$1.yaml" --out "$1"
  expect_text stderr "$1.yaml:[0-9]*:[0-9]*: error: $3"
  expect_absent "$1"
}
bad dense "${sand/d0: 0.53/d0: 0.9}" 'void_ratio_d0 < void_ratio_c0 < void_ratio_i0 must hold: 0.9, 0.84, 1'
bad n_large "${sand/n: 0.28/n: 1.2}" '.*exponent_n'
bad n_zero "${sand/n: 0.28/n: 0}" '.*exponent_n'
bad n_negative "${sand/n: 0.28/n: -0.3}" '.*exponent_n'
bad frictionless "${coulomb/deg: 30/deg: 0}" 'friction_angle_deg = 0 needs a cohesion_pa above 0'
bad dilation "$coulomb
    dilation_angle_deg: 40" '.*must not exceed friction_angle_deg'
bad indices "    model: modified_cam_clay
    compression_index_lambda: 0.02
    swelling_index_kappa: 0.04
    critical_stress_ratio: 1
    poisson_ratio: 0.3
    void_ratio: 1
    overconsolidation_ratio: 2
    density_kg_m3: 1800" 'compression_index_lambda > swelling_index_kappa > 0 must hold'
bad yields "    model: hencky_von_mises
    youngs_modulus_pa: 1.0e7
    poisson_ratio: 0.3
    density_kg_m3: 1800
    yield_radius_pa: 1
    yield_uniaxial_pa: 1" 'exactly one of yield_radius_pa'

write cohesive "$(sed 's/deg: 30/deg: 0/; s/pa: 0$/pa: 2.0e4/' <<<"$coulomb")"
expect_exit 0 "$program" element cohesive.yaml --set element.pictures=false --out cohesive
checks=$((checks + 1))
if grep -qi nan cohesive/element.csv; then fail "phi = 0 with cohesion gives NaN"; fi
write good "$sand"
expect_exit 0 "$program" element good.yaml --set element.pictures=false --out good
done_checking
