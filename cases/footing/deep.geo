// SPDX-License-Identifier: GPL-3.0-or-later
// Half of a footing of width 1 with vertical sides on ground 5 deep and 5 wide, one layer thick, with room above
// the ground beside it.
// Set from a scene: mesh: numbers: level=1, or under=3 beside=7 down=6 up=5
DefineConstant[ level = {1} ];    // number of quadrilaterals along each line, times those below
DefineConstant[ wide = {5} ];
DefineConstant[ deep = {5} ];
DefineConstant[ room = {2} ];
DefineConstant[ under = {4} ];
DefineConstant[ beside = {9} ];
DefineConstant[ down = {8} ];
DefineConstant[ up = {7} ];
DefineConstant[ growth = {2.6} ];   // log of the largest over the smallest beside the footing and with depth
DefineConstant[ thick = {0.25} ];

Point(1) = {0, 0, 0};
Point(2) = {0.5, 0, 0};
Point(3) = {wide, 0, 0};
Point(4) = {wide, -deep, 0};
Point(5) = {0.5, -deep, 0};
Point(6) = {0, -deep, 0};
Point(7) = {wide, room, 0};
Point(8) = {0.5, room, 0};
Line(1) = {2, 1};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {5, 4};
Line(5) = {5, 6};
Line(6) = {1, 6};
Line(7) = {2, 5};
Line(8) = {3, 7};
Line(9) = {8, 7};
Line(10) = {2, 8};
Curve Loop(1) = {1, 6, -5, -7};
Curve Loop(2) = {2, 3, -4, -7};
Curve Loop(3) = {2, 8, -9, -10};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Plane Surface(3) = {3};
Transfinite Curve {1, 5} = under * level + 1;
Transfinite Curve {2, 4, 9} = beside * level + 1 Using Progression Exp(growth / (beside * level));
Transfinite Curve {3, 6, 7} = down * level + 1 Using Progression Exp(growth / (down * level));
Transfinite Curve {8, 10} = up * level + 1 Using Progression Exp(0.7 / (up * level));
Transfinite Surface {1, 2, 3};
a[] = Extrude {0, 0, thick / level} { Surface{1}; Layers{1}; };
b[] = Extrude {0, 0, thick / level} { Surface{2}; Layers{1}; };
c[] = Extrude {0, 0, thick / level} { Surface{3}; Layers{1}; };

Physical Volume("ground") = {a[1], b[1]};
Physical Volume("room") = {c[1]};
Physical Surface("near") = {1, 2, 3};
Physical Surface("far") = {a[0], b[0], c[0]};
Physical Surface("strip") = {a[2]};
Physical Surface("middle") = {a[3]};
Physical Surface("side") = {b[3], c[3]};
Physical Surface("wall") = {c[5]};
Physical Surface("base") = {a[4], b[4]};
