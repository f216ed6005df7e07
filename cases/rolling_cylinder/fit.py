#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compare the motion of the cylinder with that of a rigid one.

usage: fit.py RUN_FOLDER [TILT_DEG FRICTION]

Fits x = x0 + v0 t + a t^2 / 2 to history.csv from 0.3 s after the tilt on, by least squares.
Rigid cylinder (thesis eq. 2.54, 2.55): a = (2/3) g sin(tilt) when it rolls, which it does for
friction >= tan(tilt) / 3, else a = g (sin(tilt) - friction cos(tilt)); it turns by
phi = x / R, or phi R / x = 2 friction / (tan(tilt) - friction); over the same time the slope of its
spin times R over a, which leaves out the start, is fitted, too. TILT_DEG and FRICTION are read
from the name of the scene in summary.json unless given.
"""
import csv
import json
import math
import sys

GRAVITY, RADIUS, DENSITY, TILT_AT, FIT_FROM = 10.0, 1.6, 1000.0, 2.0, 0.3


def solve(matrix, right):
    """Gauss elimination with pivoting."""
    n = len(right)
    rows = [row[:] + [b] for row, b in zip(matrix, right)]
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(k + 1, n):
            factor = rows[i][k] / rows[k][k]
            rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k])]
    out = [0.0] * n
    for k in reversed(range(n)):
        rest = sum(rows[k][j] * out[j] for j in range(k + 1, n))
        out[k] = (rows[k][n] - rest) / rows[k][k]
    return out


def fit_parabola(times, values):
    """Coefficients c of c0 + c1 t + c2 t^2."""
    powers = [[t**k for k in range(3)] for t in times]
    matrix = [[sum(p[i] * p[j] for p in powers) for j in range(3)] for i in range(3)]
    right = [sum(p[i] * v for p, v in zip(powers, values)) for i in range(3)]
    return solve(matrix, right)


def fit_line(times, values):
    """Slope of a line."""
    mean_t, mean_v = sum(times) / len(times), sum(values) / len(values)
    across = sum((t - mean_t) * (v - mean_v) for t, v in zip(times, values))
    return across / sum((t - mean_t) ** 2 for t in times)


def exact(tilt, friction):
    """Acceleration along the plane, and turned angle times radius over the way."""
    sin, cos = math.sin(tilt), math.cos(tilt)
    if friction >= math.tan(tilt) / 3.0:
        return 2.0 / 3.0 * GRAVITY * sin, 1.0
    return GRAVITY * (sin - friction * cos), 2.0 * friction / (math.tan(tilt) - friction)


def read_history(folder):
    with open(folder + "/history.csv", newline="") as file:
        rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
    names = rows[0]
    columns = {n: [float(row[k]) for row in rows[1:]] for k, n in enumerate(names)}
    start = max(k for k, t in enumerate(columns["time_s"]) if t <= TILT_AT * (1.0 + 1e-9))
    return {n: c[start:] for n, c in columns.items()}


def find_case(folder):
    with open(folder + "/summary.json") as file:
        scene = json.load(file)["scene"]
    slides = "no_slip" not in str(scene) and "slip" in str(scene)
    return (60.0, 0.286) if slides else (45.0, 0.495)


def main():
    folder = sys.argv[1]
    tilt_deg, friction = map(float, sys.argv[2:4]) if len(sys.argv) > 3 else find_case(folder)
    history = read_history(folder)
    time = [t - history["time_s"][0] for t in history["time_s"]]
    way = [x - history["cylinder_x_m"][0] for x in history["cylinder_x_m"]]
    spin = history["cylinder_spin_rad_s"]
    angle = [0.0]
    for k in range(1, len(time)):
        angle.append(angle[-1] - 0.5 * (spin[k] + spin[k - 1]) * (time[k] - time[k - 1]))
    late = [k for k, t in enumerate(time) if t >= FIT_FROM]
    c = fit_parabola([time[k] for k in late], [way[k] for k in late])
    a, ratio = exact(math.radians(tilt_deg), friction)
    print(f"tilt {tilt_deg:g} deg, friction {friction:g}, {time[-1]:.3f} s on the incline")
    print(f"fitted acceleration {2 * c[2]:.5f} m/s2, exact {a:.5f}, ratio {2 * c[2] / a:.4f}")
    for t in (0.5, 1.0, 1.5, 2.0):
        if t <= time[-1] + 1e-6:
            k = min(range(len(time)), key=lambda i: abs(time[i] - t))
            print(f"x({t:g} s) {way[k]:.5f} m, exact {0.5 * a * t * t:.5f}, "
                  f"ratio {way[k] / (0.5 * a * t * t):.4f}")
    if way[-1] != 0.0:
        print(f"turned angle x radius / way {angle[-1] * RADIUS / way[-1]:.4f}, exact {ratio:.4f}")
    faster = fit_line([time[k] for k in late], [-spin[k] for k in late])
    print(f"fitted spin acceleration x radius / fitted acceleration {faster * RADIUS / (2 * c[2]):.4f}, "
          f"exact {ratio:.4f}")
    weight = DENSITY * math.pi * RADIUS**2 * GRAVITY * math.cos(math.radians(tilt_deg))
    push = [-history["contact_force_y_n"][k] for k in late]
    print(f"mean normal force / (m g cos tilt) {sum(push) / len(push) / weight:.4f}")


main()
