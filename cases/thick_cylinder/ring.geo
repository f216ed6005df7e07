// SPDX-License-Identifier: GPL-3.0-or-later
// A quarter of a thick cylinder, one layer thick, n quadrilaterals through the wall.
// Set from a scene: mesh: numbers: n=6
DefineConstant[ n = {6} ];
DefineConstant[ inner = {0.1} ];
DefineConstant[ outer = {0.2} ];

Point(1) = {0, 0, 0};
Point(2) = {inner, 0, 0};
Point(3) = {outer, 0, 0};
Point(4) = {0, outer, 0};
Point(5) = {0, inner, 0};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1:4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1;
Transfinite Curve {2, 4} = 2 * Ceil(1.178 * n) + 1;
Transfinite Surface {1} Alternated;
out[] = Extrude {0, 0, (outer - inner) / n} { Surface{1}; Layers{1}; };

Physical Volume("wall") = {out[1]};
Physical Surface("near") = {1};
Physical Surface("far") = {out[0]};
Physical Surface("along_x") = {out[2]};
Physical Surface("outside") = {out[3]};
Physical Surface("along_y") = {out[4]};
Physical Surface("bore") = {out[5]};
