// SPDX-License-Identifier: GPL-3.0-or-later
// A quarter of a tube, one layer thick, n quadrilaterals through its wall, and room for it to widen.
// Set from a scene: mesh: numbers: n=6
DefineConstant[ n = {6} ];
DefineConstant[ inner = {1} ];
DefineConstant[ outer = {2} ];
DefineConstant[ end = {2.5} ];

Point(1) = {0, 0, 0};
Point(2) = {inner, 0, 0};
Point(3) = {outer, 0, 0};
Point(4) = {end, 0, 0};
Point(5) = {0, end, 0};
Point(6) = {0, outer, 0};
Point(7) = {0, inner, 0};
Line(1) = {2, 3};
Line(2) = {3, 4};
Circle(3) = {4, 1, 5};
Line(4) = {5, 6};
Line(5) = {6, 7};
Circle(6) = {7, 1, 2};
Circle(7) = {3, 1, 6};
Curve Loop(1) = {1, 7, 5, 6};
Curve Loop(2) = {2, 3, 4, -7};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Transfinite Curve {1, 5} = n + 1;
Transfinite Curve {2, 4} = Ceil(n * (end - outer) / (outer - inner)) + 1;
Transfinite Curve {3, 6, 7} = 2 * n + 1;
Transfinite Surface {1, 2} Alternated;
a[] = Extrude {0, 0, (outer - inner) / n} { Surface{1}; Layers{1}; };
b[] = Extrude {0, 0, (outer - inner) / n} { Surface{2}; Layers{1}; };

Physical Volume("wall") = {a[1]};
Physical Volume("room") = {b[1]};
Physical Surface("near") = {1, 2};
Physical Surface("far") = {a[0], b[0]};
Physical Surface("along_x") = {a[2], b[2]};
Physical Surface("along_y") = {a[4], b[4]};
Physical Surface("bore") = {a[5]};
