#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Load over limit from a run's history.csv, step by step.

usage: factor.py FOLDER [LEVEL]     LEVEL of the mesh, 1 unless given

The slab is 0.2/LEVEL thick and half of the strip or ligament 0.5 wide; c_u = 1 Pa for the footing,
1/sqrt(3) Pa for the notched bar, told apart by the sign of the force. The limit is (2 + pi) c_u.
"""
import csv
import math
import sys


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__.strip())
    level = int(sys.argv[2]) if len(sys.argv) == 3 else 1
    with open(sys.argv[1] + "/history.csv", newline="") as file:
        rows = [r for r in csv.DictReader(file) if float(r["step"]) > 0]
    before = first = 0.0
    for r in rows:
        force = float(r["boundary_0_force_y_n"])
        strength = 1.0 if force < 0.0 else 1.0 / math.sqrt(3)
        ratio = abs(force) / (0.5 * 0.2 / level) / ((2 + math.pi) * strength)
        first = first or ratio
        print(f"step {float(r['step']):3.0f}: load/limit {ratio:.4f}, slope {(ratio - before) / first:.4f} "
              f"of the first, {float(r['iterations']):.0f} iterations")
        before = ratio


if __name__ == "__main__":
    main()
