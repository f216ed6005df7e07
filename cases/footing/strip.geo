// SPDX-License-Identifier: GPL-3.0-or-later
// Half of a strip of width 1 at y = 0 over a rectangle, one layer thick; elements smallest at its edge.
// Set from a scene: mesh: numbers: level=1 wide=3 deep=1.5
DefineConstant[ level = {1} ];    // number of quadrilaterals along each line, times those below
DefineConstant[ wide = {3} ];
DefineConstant[ deep = {1.5} ];
DefineConstant[ under = {6} ];    // under the strip
DefineConstant[ beside = {8} ];
DefineConstant[ down = {7} ];
DefineConstant[ growth = {2.3} ]; // log of the largest over the smallest under the strip
DefineConstant[ more = {0.5} ];   // beside it, and more_down with depth: in addition
DefineConstant[ more_down = {0.2} ];
DefineConstant[ thick = {0.2} ];

g = growth + 0.35 * (level - 1);
Point(1) = {0, 0, 0};
Point(2) = {0.5, 0, 0};
Point(3) = {wide, 0, 0};
Point(4) = {wide, -deep, 0};
Point(5) = {0.5, -deep, 0};
Point(6) = {0, -deep, 0};
Line(1) = {2, 1};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {5, 4};
Line(5) = {5, 6};
Line(6) = {1, 6};
Line(7) = {2, 5};
Curve Loop(1) = {1, 6, -5, -7};
Curve Loop(2) = {2, 3, -4, -7};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Transfinite Curve {1, 5} = under * level + 1 Using Progression Exp(g / (under * level));
Transfinite Curve {2, 4} = beside * level + 1 Using Progression Exp((g + more) / (beside * level));
Transfinite Curve {3, 6, 7} = down * level + 1 Using Progression Exp((g + more_down) / (down * level));
Transfinite Surface {1, 2};
a[] = Extrude {0, 0, thick / level} { Surface{1}; Layers{1}; };
b[] = Extrude {0, 0, thick / level} { Surface{2}; Layers{1}; };

Physical Volume("ground") = {a[1], b[1]};
Physical Surface("near") = {1, 2};
Physical Surface("far") = {a[0], b[0]};
Physical Surface("strip") = {a[2]};
Physical Surface("middle") = {a[3]};
Physical Surface("side") = {b[3]};
Physical Surface("base") = {a[4], b[4]};
