// SPDX-License-Identifier: GPL-3.0-or-later
// A quarter of a bar between deep notches: the footing's rectangle, the ligament in place of the strip.
// Set from a scene: mesh: numbers: level=1
DefineConstant[ wide = {5} ];
DefineConstant[ deep = {15} ];
DefineConstant[ under = {5} ];
DefineConstant[ beside = {9} ];
DefineConstant[ down = {10} ];
DefineConstant[ more = {2.2} ];
DefineConstant[ more_down = {2.2} ];
Include "../footing/strip.geo";
