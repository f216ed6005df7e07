#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Meshes that a solid scene cannot be run on: exit status 2, and what is wrong at the key that says
# so, with cells and groups by name; nothing written.
. "$(dirname "$0")/harness.sh"
grep -q '^GMSH_LIBRARY:FILEPATH=.*NOTFOUND' "$build/CMakeCache.txt" && exit 77

# mesh NAME NODES TETS: a linear gmsh 2.2 mesh; a tetrahedron is "GROUP a b c d".
mesh() {
  {
    printf '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n2 1 "base"\n3 2 "soil"\n3 3 "pile"\n'
    printf '$EndPhysicalNames\n$Nodes\n%s\n%s\n$EndNodes\n' "$(echo "$2" | wc -l)" "$2"
    printf '$Elements\n%s\n1 2 2 1 1 1 2 3\n' "$(($(echo "$3" | wc -l) + 1))"
    echo "$3" | awk '{print NR + 10, 4, 2, $1, $1, $2, $3, $4, $5}'
    printf '$EndElements\n'
  } >"$1.msh"
}

scene() {
  cat >"$1.yaml" <<END
geometry: solid
mesh:
  kind: file
  file: $1.msh
implicit: {steps: 1, fbar: none}
materials: {clay: {model: hencky_von_mises, density_kg_m3: 1, youngs_modulus_pa: 1e6,
    poisson_ratio: 0.3, undrained_shear_strength_pa: 1e4}}
bodies:
  ground: {material: clay}
boundary:
  - {group: base, fix_x: true, fix_y: true, fix_z: true}
END
}

# expect_bad REGEX SCENE OPTIONS...
expect_bad() {
  text=$1
  shift
  for command in run check; do
    expect_exit 2 "$program" $command "$@"
    expect_text stderr "$text"
  done
  expect_absent out
}

nodes='1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 1 1 1'
mesh good "$nodes" '2 1 2 3 4
2 2 3 4 5'
scene good
expect_exit 0 "$program" check good.yaml
expect_text stdout '2 elements, 5 nodes'

mesh inverted "$nodes" '2 1 2 3 4
3 2 4 3 5'
scene inverted
expect_bad "inverted.yaml:2:1: error: mesh: cell 12 of volume 'pile' is inside out" inverted.yaml

mesh flat '1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 0.7 0.7 -0.399999' '2 1 2 3 4
3 2 3 4 5'
scene flat
expect_bad "flat.yaml:2:1: error: mesh: cell 12 of volume 'pile' is flat: its volume is" flat.yaml

mesh apart "$nodes
6 3 0 0
7 4 0 0
8 3 1 0
9 3 0 1" '2 1 2 3 4
2 2 3 4 5
3 6 7 8 9'
scene apart
expect_bad "apart.yaml:2:1: error: mesh: .* 1 cells, such as 13 of volume 'pile', are not joined to cell 11 of volume 'soil'" apart.yaml

mesh isolated "$nodes
6 3 0 0" '2 1 2 3 4
2 2 3 4 5'
sed -i 's/^1 2 2 1 1 1 2 3$/1 2 2 1 1 1 2 6/' isolated.msh
scene isolated
expect_bad 'isolated.yaml:4:9: error: mesh.file: .*node 6 at \(3, 0, 0\) belongs to no tetrahedron' \
  isolated.yaml

sed 's/group: base/group: bas/' good.yaml >group.yaml
expect_bad "group.yaml:11:13: error: boundary.0.group: the mesh has no physical group 'bas'; it has base, soil" \
  group.yaml
expect_bad '^--set boundary.0.group=bas: error: boundary.0.group: the mesh has no physical group' \
  good.yaml --set boundary.0.group=bas
expect_bad "bodies.ground.volume: the mesh has no volume 'sand'; it has soil" good.yaml \
  --set bodies.ground.volume=sand
sed 's/fbar: none/fbar: increment/' good.yaml >patch.yaml
expect_bad 'patch.yaml:5:28: error: implicit.fbar: a patch is a ten-node tetrahedron' patch.yaml
expect_bad 'implicit.points_per: .* no ten-node' good.yaml --set implicit.points_per=ten_node
expect_bad 'missing.msh' good.yaml --set mesh.file=missing.msh
echo 'Printf("no mesh");' >script.msh
expect_bad 'script.msh: no gmsh mesh' good.yaml --set mesh.file=script.msh
expect_bad 'bodies.ground: it fills no cell' good.yaml --set 'bodies.ground.low_m=[5, 5, 5]' \
  --set 'bodies.ground.high_m=[6, 6, 6]'
expect_bad 'tracer.0.at_m: .* is outside the mesh' good.yaml --set 'tracer=[{at_m: [9, 9, 9]}]'
expect_bad "traction.0.group: the mesh has no surface 'soil'" good.yaml \
  --set 'traction=[{group: soil, pressure_pa: 1}]'

# A geometry that gmsh refuses, and numbers that are none.
echo 'Point(1) = {0, 0, 0}; Line(1) = {1, 7};' >refused.geo
expect_bad 'good.yaml:4:|--set mesh.file' good.yaml --set mesh.file=refused.geo
echo 'DefineConstant[ n = {1} ]; SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 1, 1, n};
Physical Volume("soil") = {1}; Physical Surface("base") = {5};' >box.geo
expect_exit 0 "$program" check good.yaml --set mesh.file=box.geo --set mesh.numbers=n=3
expect_text stdout 'to \(1, 1, 3\) m'
expect_text stderr '^meshing .*box.geo'
expect_bad 'mesh.numbers: ' good.yaml --set mesh.file=box.geo --set mesh.numbers=n
expect_bad "mesh.numbers: the name 'nn' does not occur in .*box.geo" good.yaml \
  --set mesh.file=box.geo --set mesh.numbers=nn=3

# gmsh keeps to one thread, the run does not.
for file in good.msh box.geo; do
  expect_exit 0 env OMP_NUM_THREADS=2 "$program" check good.yaml --set mesh.file=$file
  expect_text stdout '^threads +2$'
done

# Tetrahedra of two orders in one volume, and of third order.
tetrahedra() {
  printf '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 "soil"\n$EndPhysicalNames\n' >$1
  printf '$Nodes\n%d\n' $(wc -l <<<"$2") >>$1
  nl -w1 -s' ' <<<"$2" >>$1
  printf '$EndNodes\n$Elements\n%d\n%s\n$EndElements\n' $(wc -l <<<"$3") "$3" >>$1
}
ten='0 0 0
1 0 0
0 1 0
0 0 1
.5 0 0
.5 .5 0
0 .5 0
0 0 .5
0 .5 .5
.5 0 .5
1 1 1'
tetrahedra mixed.msh "$ten" '1 11 2 1 1 1 2 3 4 5 6 7 8 9 10
2 4 2 1 1 2 3 4 11'
expect_bad 'mixed.msh: linear and ten-node tetrahedra are mixed' good.yaml --set mesh.file=mixed.msh
tetrahedra third.msh "$ten"$'\n2 2 2\n3 3 3\n4 4 4\n5 5 5\n6 6 6\n7 7 7\n8 8 8\n9 9 9\n1 2 3' \
  "1 29 2 1 1 $(seq -s' ' 20)"
expect_bad 'third.msh: tetrahedra of third order' good.yaml --set mesh.file=third.msh
done_checking
