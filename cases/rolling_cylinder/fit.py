#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compare the motion of the cylinder with that of a rigid one.

usage: fit.py RUN_FOLDER [TILT_DEG FRICTION [TURN_S]]

Fits x = x0 + v0 t + a t^2 / 2 to history.csv from 0.3 s after the tilt on, by least squares.
Rigid cylinder (thesis eq. 2.54, 2.55): a = (2/3) g sin(tilt) when it rolls, which it does for
friction >= tan(tilt) / 3, else a = g (sin(tilt) - friction cos(tilt)); it turns by
phi = x / R, or phi R / x = 2 friction / (tan(tilt) - friction); over the same time the slope of its
spin times R over a, which leaves out the start, is fitted, too. TILT_DEG and FRICTION are read
from the name of the scene in summary.json unless given. TURN_S is gravity.tilt_over_s of the run:
then the tilt counts from the end of the turn, and way and angle are compared with those of a rigid
cylinder under the gravity of the turn, from step-by-step integration.
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


def rigid_motion(tilt, friction, turn, end):
    """Way and turned angle of a rigid cylinder at `end` after the beginning of a turn that takes
    `turn`: gravity's angle goes from 0 to tilt as half a cosine. It rolls while friction can."""
    n, way, angle, speed, rim = 20000, 0.0, 0.0, 0.0, 0.0
    dt = end / n
    for k in range(n):
        share = min(1.0, (k + 0.5) * dt / turn) if turn > 0.0 else 1.0
        now = 0.5 * (1.0 - math.cos(math.pi * share)) * tilt
        pull, most = GRAVITY * math.sin(now), friction * GRAVITY * math.cos(now)
        held = pull / 3.0 if speed <= rim + 1e-9 else most  # rim: speed of the surface by turning
        held = min(held, most)
        before, rim_before = speed, rim
        speed += dt * (pull - held)
        rim += dt * 2.0 * held
        rim = min(rim, speed)
        way += 0.5 * dt * (before + speed)
        angle += 0.5 * dt * (rim_before + rim) / RADIUS
    return way, angle


def find_case(folder):
    with open(folder + "/summary.json") as file:
        scene = json.load(file)["scene"]
    slides = "no_slip" not in str(scene) and "slip" in str(scene)
    return (60.0, 0.286) if slides else (45.0, 0.495)


def missing_moment(history, first, last):
    """What is missing of the impulse of friction times the radius for the spin that the cylinder
    gains between two rows, over the impulse of the normal force; m. It is where that force stands
    ahead of the centre, if nothing else takes moment."""
    time = history["time_s"]

    def impulse(name):
        c = history[name]
        return sum(0.5 * (c[k] + c[k + 1]) * (time[k + 1] - time[k]) for k in range(first, last))

    spin = history["cylinder_spin_rad_s"]
    gained = -0.5 * DENSITY * math.pi * RADIUS**4 * (spin[last] - spin[first])
    return (impulse("contact_force_x_n") * RADIUS - gained) / -impulse("contact_force_y_n")


def fitted(folder, tilt_deg, friction, turn=0.0):
    """Ratios of a run's figures to a rigid cylinder's: a dictionary of the figures of verification
    A11 and those printed beside them."""
    tilt = math.radians(tilt_deg)
    history = read_history(folder)
    time = [t - history["time_s"][0] for t in history["time_s"]]
    way = [x - history["cylinder_x_m"][0] for x in history["cylinder_x_m"]]
    spin = [-w for w in history["cylinder_spin_rad_s"]]
    angle = [0.0]
    for k in range(1, len(time)):
        angle.append(angle[-1] + 0.5 * (spin[k] + spin[k - 1]) * (time[k] - time[k - 1]))
    late = [k for k, t in enumerate(time) if t >= turn + FIT_FROM - 1e-9]
    times = [time[k] for k in late]
    if len(times) < 10:
        sys.exit(f"{folder}/history.csv: ends {time[-1]:.3f} s after the tilt, too early for a fit "
                 f"from {turn + FIT_FROM:g} s on")
    a = 2.0 * fit_parabola(times, [way[k] for k in late])[2]
    faster = fit_line(times, [spin[k] for k in late])
    weight = DENSITY * math.pi * RADIUS**2 * GRAVITY * math.cos(tilt)
    push = [-history["contact_force_y_n"][k] / weight for k in late]
    exact_a, exact_turning = exact(tilt, friction)
    ways = [(t, way[k], rigid_motion(tilt, friction, turn, t)[0])
            for t in (0.5, 1.0, 1.5, 2.0) for k in [round(100 * t)]
            if k < len(time) and abs(time[k] - t) < 1e-6]
    rigid_way, rigid_angle = rigid_motion(tilt, friction, turn, time[-1])
    return {"end": time[-1], "a": a, "exact_a": exact_a, "ways": ways,
            "turning": angle[-1] * RADIUS / way[-1],
            "exact_turning": rigid_angle * RADIUS / rigid_way,
            "late_turning": faster * RADIUS / a, "exact_late_turning": exact_turning,
            "push": sum(push) / len(push), "push_range": (min(push), max(push)),
            "offset_m": missing_moment(history, late[0], late[-1])}


def main():
    folder = sys.argv[1]
    tilt_deg, friction = map(float, sys.argv[2:4]) if len(sys.argv) > 3 else find_case(folder)
    turn = float(sys.argv[4]) if len(sys.argv) > 4 else 0.0
    f = fitted(folder, tilt_deg, friction, turn)
    print(f"tilt {tilt_deg:g} deg, friction {friction:g}, {f['end']:.3f} s on the incline")
    print(f"fitted acceleration {f['a']:.5f} m/s2, exact {f['exact_a']:.5f}, "
          f"ratio {f['a'] / f['exact_a']:.4f}")
    for t, way, exact_way in f["ways"]:
        print(f"x({t:g} s) {way:.5f} m, exact {exact_way:.5f}, ratio {way / exact_way:.4f}")
    print(f"turned angle x radius / way {f['turning']:.4f}, exact {f['exact_turning']:.4f}")
    print(f"fitted spin acceleration x radius / fitted acceleration {f['late_turning']:.4f}, "
          f"exact {f['exact_late_turning']:.4f}")
    print(f"mean normal force / (m g cos tilt) {f['push']:.4f}, "
          f"from {f['push_range'][0]:.2f} to {f['push_range'][1]:.2f}")
    print(f"moment missing of friction x radius: {1e3 * f['offset_m']:.1f} mm x mean normal force")


if __name__ == "__main__":
    main()
