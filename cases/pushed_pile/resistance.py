#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Resistance of a pushed pile over its base area against depth, from a run's history.csv.

usage: resistance.py FOLDER [radius_m]
"""
import csv
import math
import sys


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    radius = float(sys.argv[2]) if len(sys.argv) > 2 else 0.15
    area = math.pi * radius * radius
    with open(sys.argv[1] + "/history.csv", newline="") as file:
        rows = [(float(r["penetration_m"]), float(r["contact_force_y_n"]))
                for r in csv.DictReader(file)]
    print("depth_m  resistance_kpa (mean over 0.1 m)")
    for k in range(2, 30):
        depth = 0.1 * k
        near = [f for x, f in rows if abs(x - depth) <= 0.05]
        if near and rows[-1][0] >= depth + 0.05:
            print(f"{depth:7.1f}  {1e-3 * sum(near) / len(near) / area:14.0f}")


main()
