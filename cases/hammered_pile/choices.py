#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the thesis leaves open, one choice changed at a time: gravity stage and push of its pile.

usage: choices.py gravity|push|independent [--end S] [--only NAME,...] [--contacts penalty,frictional]
                               [--out DIR] [--program FILE] [--threads N]

gravity: cases/hammered_pile/penalty.yaml and frictional.yaml to the end of the ramp (2 s): depth of
the tip below the first surface and, of it, the far-field settlement, at 1 s and at 2 s. Some 80 s
of computing a run; --end 1 takes some 30 s and tells most.
push: cases/pushed_pile/penalty.yaml to 1 m: resistance over base area, mean over 0.1 m of way. Some
50 s a run.
independent: the five figures of an independent program beside those of one setting of two open
choices, points of 0.072 m all over and lines split where longer than three segments. The setting was
chosen with the figures known (README). Three runs; exit status 1 if one is outside its tolerance.
A table is printed and written to DIR/table.txt. Python's standard library only.
"""
import argparse
import csv
import math
import pathlib
import subprocess
import sys

CASES = pathlib.Path(__file__).resolve().parents[1]
RADIUS = 0.15                     # m, of the pile
DEPTHS = [0.1 * k for k in (4, 6, 8, 10)]  # m, at which the push is compared
BAND = 0.05                       # m, half of the way over which resistance is averaged
SAND = "materials.sand."
NO_SPLIT = ["contact_penalty.split_factor=100", "contact_penalty.thin_factor=0"]

BOTH, PENALTY, FRICTIONAL = ("penalty", "frictional"), ("penalty",), ("frictional",)


def stiffness(value):
    return [f"contact_penalty.{way}_stiffness_pa_m={value}" for way in ("normal", "tangential")]


def across(size):
    """Points of one size that is no part of a cell, so that they lie across the cells."""
    return [f"bodies.soil.point_size_m={size}", f"bodies.soil.refine.0.point_size_m={size}"]


# name: (contacts, settings)
GRAVITY = {
    "as shipped": (BOTH, []),
    "mobilised oedometric": (BOTH, [SAND + "initial_intergranular=oedometric"]),
    "mobilised isotropic": (PENALTY, [SAND + "initial_intergranular=isotropic"]),
    "no intergranular strain": (BOTH, [SAND + "intergranular_strain=false"]),
    "tip twice as long": (BOTH, ["bodies.pile.tip_length_m=0.3"]),
    "p_t = 1 kPa": (BOTH, [SAND + "cohesion_shift_pa=1000"]),
    "p_t = 0": (BOTH, [SAND + "cohesion_shift_pa=0"]),
    "USL": (BOTH, ["method.update=usl"]),
    "cfl 0.9": (PENALTY, ["time.cfl=0.9"]),
    "domain limit half a cell": (PENALTY, ["method.domain_limit_cells=0.5"]),
    "one point a cell": (BOTH, ["bodies.soil.refine.0.point_size_m=0.125"]),
    "points of 0.065 m across the cells": (BOTH, across(0.065)),
    "points of 0.067 m across the cells": (BOTH, across(0.0667)),
    "points of 0.068 m across the cells": (BOTH, across(0.068)),
    "points of 0.07 m across the cells": (BOTH, across(0.0704)),
    "points of 0.071 m across the cells": (BOTH, across(0.0708)),
    "points of 0.072 m across the cells": (BOTH, across(0.072)),
    "points of 0.073 m across the cells": (BOTH, across(0.0735)),
    "points of 0.076 m across the cells": (BOTH, across(0.076)),
    "16 points a cell near the pile": (BOTH, ["bodies.soil.refine.0.x_m=[0,1.25]",
                                              "bodies.soil.refine.0.y_m=[5,10]",
                                              "bodies.soil.refine.0.point_size_m=0.03125"]),
    "points of 0.03 m in the pile": (BOTH, ["bodies.pile.point_size_m=0.03"]),
    "points of 0.0375 m in the pile": (BOTH, ["bodies.pile.point_size_m=0.0375"]),
    "points of 0.075 m in the pile": (BOTH, ["bodies.pile.point_size_m=0.075"]),
    "surface half a cell higher": (BOTH, ["bodies.pile.tip_y_m=10.0625",
                                          "bodies.soil.y_m=[0,10.0625]"]),
    "segments of 0.02 m": (PENALTY, ["contact_penalty.segment_m=0.02"]),
    "contact 10 times as stiff": (PENALTY, stiffness("1e9")),
    "no friction": (PENALTY, ["contact_penalty.friction=0"]),
    "normals of both bodies": (FRICTIONAL, ["contact_frictional.normal=average"]),
    "normals of the soil": (FRICTIONAL, ["contact_frictional.normal=slave"]),
}
PUSH = {
    "as shipped": (PENALTY, []),
    "split at 0.1 m": (PENALTY, ["contact_penalty.split_factor=2"]),
    "split at 0.15 m": (PENALTY, ["contact_penalty.split_factor=3"]),
    "split at 0.165 m": (PENALTY, ["contact_penalty.split_factor=3.3"]),
    "split at 0.175 m": (PENALTY, ["contact_penalty.split_factor=3.5"]),
    "split at 0.2 m": (PENALTY, ["contact_penalty.split_factor=4"]),
    "never split": (PENALTY, NO_SPLIT),
    "segments of 0.02 m": (PENALTY, ["contact_penalty.segment_m=0.02"]),
    "segments of 0.02 m never split": (PENALTY, ["contact_penalty.segment_m=0.02"] + NO_SPLIT),
    "contact a tenth as stiff": (PENALTY, stiffness("1e7")),
    "mobilised oedometric": (PENALTY, [SAND + "initial_intergranular=oedometric"]),
    "p_t = 0": (PENALTY, [SAND + "cohesion_shift_pa=0"]),
    "USL": (PENALTY, ["method.update=usl"]),
    "domain limit half a cell": (PENALTY, ["method.domain_limit_cells=0.5"]),
    "tip twice as long": (PENALTY, ["bodies.pile.tip_length_m=0.3"]),
}
STUDIES = {"gravity": (GRAVITY, "hammered_pile", 2.0), "push": (PUSH, "pushed_pile", 1.06)}

SPLIT_AT_3 = ["contact_penalty.split_factor=3"]
# study, contact, settings, {time or depth: (figure of the independent program, tolerance)}
INDEPENDENT = [
    ("gravity", "penalty", across(0.072) + SPLIT_AT_3, {2.0: (0.12, 0.15)}),
    ("gravity", "frictional", across(0.072), {2.0: (0.08, 0.15)}),
    ("push", "penalty", ["bodies.soil.point_size_m=0.072"] + SPLIT_AT_3,
     {0.6: (570, 0.2), 0.8: (720, 0.2), 1.0: (1010, 0.2)}),
]


def arguments():
    p = argparse.ArgumentParser(description=__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("study", choices=[*STUDIES, "independent"])
    p.add_argument("--end", type=float, help="end_s of the runs; default: 2 and 1.06")
    p.add_argument("--only", help="names of the choices to run, separated by commas")
    p.add_argument("--contacts", default="penalty,frictional")
    p.add_argument("--out", type=pathlib.Path)
    p.add_argument("--program", default=str(CASES.parent / "build" / "pilewright"))
    p.add_argument("--threads", type=int, default=2)
    a = p.parse_args()
    a.out = a.out or pathlib.Path("out") / f"choices_{a.study}"
    a.contacts = a.contacts.split(",")
    if a.study == "independent":
        if a.end or a.only:
            p.error("--end and --only do not go with independent")
        return a
    a.end = a.end or STUDIES[a.study][2]
    choices = STUDIES[a.study][0]
    a.only = [n.strip() for n in a.only.split(",")] if a.only else list(choices)
    unknown = [n for n in a.only if n not in choices]
    if unknown:
        p.error(f"no choice {unknown[0]!r}; there are: {', '.join(choices)}")
    return a


def run(args, study, name, contact, sets, end):
    """Rows of the run's history, as numbers."""
    folder = args.out / f"{contact}_{name.replace(' ', '_')}"
    scene = CASES / STUDIES[study][1] / f"{contact}.yaml"
    command = [args.program, "run", str(scene), "--out", str(folder), "--threads",
               str(args.threads), "--quiet", "--force"]
    for s in [f"time.end_s={end:g}", "output.paraview=false", "output.pictures=false"] + sets:
        command += ["--set", s]
    print(f"{contact}, {name}", file=sys.stderr, flush=True)
    done = subprocess.run(command, stdout=subprocess.DEVNULL)
    if done.returncode != 0:
        sys.exit(f"exit status {done.returncode} of: {' '.join(command)}")
    with open(folder / "history.csv", newline="") as file:
        return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]


def at_time(rows, t):
    return min(rows, key=lambda r: abs(r["time_s"] - t))


def gravity_cells(rows, end):
    """Depth, and the settlement in it, at 1 s and at 2 s."""
    cells = []
    for t in (1.0, 2.0):
        row = at_time(rows, t)
        cells.append(f"{row['penetration_m']:.3f} ({row['settlement_far_field_m']:.3f})"
                     if t <= end + 1e-9 else "-")
    return cells


def resistance(rows, depth):
    """Over the base area, mean over the band about a depth; kPa, or None if it is not reached."""
    near = [r["contact_force_y_n"] for r in rows if abs(r["penetration_m"] - depth) <= BAND]
    if not near or rows[-1]["penetration_m"] < depth + BAND - 1e-3:
        return None
    return 1e-3 * sum(near) / len(near) / (math.pi * RADIUS ** 2)


def push_cells(rows):
    found = [resistance(rows, depth) for depth in DEPTHS]
    return ["-" if f is None else f"{f:.0f}" for f in found]


def independent(args):
    """Table of figures beside those of the independent program; True if all are within."""
    lines = ["figure | here | independent program | difference | tolerance | within"]
    print(lines[0], flush=True)
    all_within = True
    for study, contact, sets, figures in INDEPENDENT:
        if contact not in args.contacts:
            continue
        rows = run(args, study, study, contact, sets, STUDIES[study][2])
        for at, (want, tolerance) in figures.items():
            if study == "gravity":
                found, name = at_time(rows, at)["penetration_m"], "depth after gravity, m"
            else:
                found, name = resistance(rows, at) or 0.0, f"resistance at {at:g} m, kPa"
            off = found / want - 1.0
            within = abs(off) <= tolerance
            all_within &= within
            lines.append(f"{contact}: {name} | {found:.4g} | {want:g} | {100 * off:+.1f} % | "
                         f"{100 * tolerance:g} % | {'yes' if within else 'NO'}")
            print(lines[-1], flush=True)
    (args.out / "table.txt").write_text("\n".join(lines) + "\n")
    return all_within


def main():
    args = arguments()
    if args.study == "independent":
        sys.exit(0 if independent(args) else 1)
    choices = STUDIES[args.study][0]
    if args.study == "gravity":
        head = ["choice", "contact", "1 s: depth (settlement), m", "2 s"]
    else:
        head = ["choice", "contact"] + [f"kPa at {d:g} m" for d in DEPTHS]
    lines = [" | ".join(head)]
    print(lines[0], flush=True)
    for name in args.only:
        contacts, sets = choices[name]
        for contact in [c for c in contacts if c in args.contacts]:
            rows = run(args, args.study, name, contact, sets, args.end)
            cells = gravity_cells(rows, args.end) if args.study == "gravity" else push_cells(rows)
            lines.append(" | ".join([name, contact] + cells))
            print(lines[-1], flush=True)
    (args.out / "table.txt").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
