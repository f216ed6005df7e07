#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Force against depth of a rigid punch or sphere on an elastic half space.

usage: force.py RUN_FOLDER punch|sphere

Punch (Sneddon): F = 2 E a d / (1 - nu^2); sphere (Hertz): F = 4/3 E / (1 - nu^2) sqrt(R) d^1.5.
"""
import csv
import math
import sys

YOUNGS, POISSON, RADIUS = 1.0e6, 0.3, 0.5


def main():
    folder, kind = sys.argv[1:3]
    with open(folder + "/history.csv", newline="") as file:
        rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
    column = {name: [float(row[k]) for row in rows[1:]] for k, name in enumerate(rows[0])}
    start = column[kind + "_y_m"][0]
    modulus = YOUNGS / (1.0 - POISSON**2)
    print("depth_m     force_n   exact_n     ratio")
    logs = []
    for i in range(len(rows) - 1):
        depth, force = start - column[kind + "_y_m"][i], column["contact_force_y_n"][i]
        if depth <= 0.0 or force <= 0.0:
            continue
        if kind == "punch":
            exact = 2.0 * modulus * RADIUS * depth
        else:
            exact = 4.0 / 3.0 * modulus * math.sqrt(RADIUS) * depth**1.5
        if i % 10 == 0:
            print(f"{depth:.6f} {force:10.2f} {exact:10.2f} {force / exact:9.4f}")
        if i > len(rows) // 2:
            logs.append((math.log(depth), math.log(force)))
    n = len(logs)
    mx, my = sum(a for a, _ in logs) / n, sum(b for _, b in logs) / n
    slope = sum((a - mx) * (b - my) for a, b in logs) / sum((a - mx) ** 2 for a, _ in logs)
    print(f"exponent of the second half {slope:.4f}")


main()
