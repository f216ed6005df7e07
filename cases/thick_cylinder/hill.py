#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Displacement of the outer face against Hill's solution, by pressure, from a run's history.csv.

usage: hill.py FOLDER [PRESSURE_PA]     the scene's last pressure, 0.18922e9 unless given

With Y' = 2 Y/sqrt(3): plastic up to the radius c at p = Y' (ln(c/a) + (1 - c2/b2)/2), and then
u_b = Y' c2 (1 - nu2)/(E b). Shown is the mean of the displacements along x, y and between them, the
ends counted half.
"""
import csv
import math
import sys

A, B, E, NU, Y = 0.1, 0.2, 210e9, 0.3, 0.24e9 * 2 / math.sqrt(3)


def hill(pressure):
    """Plastic radius and displacement of the outer face."""
    if pressure < Y / 2 * (1 - A * A / (B * B)):
        return A, 2 * pressure * A * A * B * (1 - NU * NU) / (E * (B * B - A * A))
    low, high = A, B
    for _ in range(60):
        middle = (low + high) / 2
        inside = Y * (math.log(middle / A) + (1 - middle * middle / (B * B)) / 2) < pressure
        low, high = (middle, high) if inside else (low, middle)
    return low, Y * low * low * (1 - NU * NU) / (E * B)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__.strip())
    last = float(sys.argv[2]) if len(sys.argv) == 3 else 0.18922e9
    with open(sys.argv[1] + "/history.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    for r in rows[1:]:
        pressure = last * float(r["step"]) / float(rows[-1]["step"])
        along = float(r["tracer_0_x_m"]), float(r["tracer_1_y_m"])
        between = (float(r["tracer_2_x_m"]) + float(r["tracer_2_y_m"])) / math.sqrt(2)
        outside = (sum(along) / 2 + between) / 2
        radius, exact = hill(pressure)
        print(f"p/limit {pressure / (Y * math.log(B / A)):.4f}, plastic to {radius:.4f} m: "
              f"u_b {1e3 * outside:.5f} mm, {outside / exact:.4f} of Hill's")


if __name__ == "__main__":
    main()
