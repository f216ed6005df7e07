#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bearing factors from a run's history.csv, for c_u = 20 kPa and a radius of 0.15 m.

usage: factor.py cone FOLDER   N_c = force on the tip / (c_u base area), by depth of the tip
       factor.py bar FOLDER    N = force / (c_u diameter), the half model's force twice, by way

Each row is the mean over one radius of way. Shear on the tip counts. The last column is the energy
that the contact added (negative: took) since the row before, over the work of the driving force.
"""
import csv
import math
import sys

C_U, RADIUS, START = 2.0e4, 0.15, 2.25


def rows_of(kind, folder):
    with open(folder + "/history.csv", newline="") as file:
        for r in csv.DictReader(file):
            lost, work = float(r["contact_dissipated_j"]), float(r["external_work_j"])
            if kind == "cone":
                way, force = float(r["penetration_m"]), float(r["contact_tip_y_n"])
                yield way / RADIUS, force / (C_U * math.pi * RADIUS * RADIUS), lost, work
            else:
                way, force = START - float(r["bar_y_m"]), float(r["contact_force_y_n"])
                yield way / RADIUS, 2.0 * force / (C_U * 2.0 * RADIUS), lost, work


def main():
    if len(sys.argv) != 3 or sys.argv[1] not in ("cone", "bar"):
        sys.exit(__doc__)
    rows = list(rows_of(sys.argv[1], sys.argv[2]))
    print("way/radius  factor  scatter  energy added by the contact")
    for way in range(1, 40):
        near = [r for r in rows if abs(r[0] - way) <= 0.5]
        if not near or rows[-1][0] < way + 0.45:
            continue
        mean = sum(r[1] for r in near) / len(near)
        scatter = math.sqrt(sum((r[1] - mean) ** 2 for r in near) / len(near))
        added = (near[0][2] - near[-1][2]) / max(near[-1][3] - near[0][3], 1e-300)
        print(f"{way:10d}  {mean:6.2f}  {scatter:7.2f}  {100 * added:8.2f} %")


main()
