// SPDX-License-Identifier: GPL-3.0-or-later
// Cross-shaped vane in a cylinder of soil, for gmsh. Lengths in m.
// Set from a scene: mesh: numbers: l=0.24 far=1.0 height=0.05
DefineConstant[ radius = {0.05} ];   // of the blades
DefineConstant[ height = {0.05} ];
DefineConstant[ l = {0.24} ];        // edge of ten-node tetrahedra at the blades, over the radius
DefineConstant[ far = {1.0} ];       // the same at the outer boundary, at 3 radii

half = 0.05 * radius;                // half the thickness of a blade
edge = l * radius;
tip = Sqrt(radius * radius - half * half);

Point(1) = {0, 0, 0, edge};
For k In {0:3}
  c = Cos(k * Pi / 2); s = Sin(k * Pi / 2);
  Point(10 + 3 * k) = {c * half - s * (-half), s * half + c * (-half), 0, edge}; // inner corner
  Point(11 + 3 * k) = {c * tip - s * (-half), s * tip + c * (-half), 0, edge};
  Point(12 + 3 * k) = {c * tip - s * half, s * tip + c * half, 0, edge};
  Point(30 + k) = {3 * radius * c, 3 * radius * s, 0, far * radius};
EndFor
For k In {0:3}
  Line(10 + 3 * k) = {10 + 3 * k, 11 + 3 * k};
  Circle(11 + 3 * k) = {11 + 3 * k, 1, 12 + 3 * k};
  Line(12 + 3 * k) = {12 + 3 * k, 10 + 3 * ((k + 1) % 4)};
  Circle(30 + k) = {30 + k, 1, 30 + (k + 1) % 4};
EndFor
Curve Loop(1) = {30:33};
Curve Loop(2) = {10:21};
Plane Surface(1) = {1, 2};
out[] = Extrude {0, 0, height} { Surface{1}; };

Physical Volume("soil") = {out[1]};
Physical Surface("bottom") = {1};
Physical Surface("top") = {out[0]};
Physical Surface("outer") = {out[2], out[3], out[4], out[5]};
Physical Surface("vane") = {out[6], out[7], out[8], out[9], out[10], out[11], out[12], out[13],
                            out[14], out[15], out[16], out[17]};
