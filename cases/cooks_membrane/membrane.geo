// SPDX-License-Identifier: GPL-3.0-or-later
// Cook's membrane, one layer thick, n by n quadrilaterals of six ten-node tetrahedra each.
// Set from a scene: mesh: numbers: n=16
DefineConstant[ n = {16} ];

Point(1) = {0, 0, 0};
Point(2) = {48, 44, 0};
Point(3) = {48, 60, 0};
Point(4) = {0, 44, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1:4};
Plane Surface(1) = {1};
Transfinite Curve {1:4} = n + 1;
Transfinite Surface {1};
out[] = Extrude {0, 0, 48 / n} { Surface{1}; Layers{1}; };

Physical Volume("membrane") = {out[1]};
Physical Surface("near") = {1};
Physical Surface("far") = {out[0]};
Physical Surface("loaded") = {out[3]};
Physical Surface("clamped") = {out[5]};
