#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Resistance, set and penetration of the thesis' pile against resolution and against time spent.

usage: converge.py push|hammer [--out DIR] [--program FILE] [--threads N]
                   [--resolutions 1.2,2.4,4.8] [--contacts corner,penalty,frictional]
                   [--end S[,S...]] [--set KEY=VALUE]...

Runs a scene with each contact at each resolution (radius of the pile over edge of a cell), one
after the other, and writes into DIR: table.csv, table.txt, and the plots resistance.png (or
penetration.png), convergence.png and time.png (gnuplot). A run that already ended with the same
settings, or failed, is not repeated. --end: when the runs end, one for all or one for each
resolution; the fine zone then ends just below the last place of the tip (push) or at 0.75 m of
depth for each blow (hammer). Before each run
it says how much time is left, once it can tell. Python's standard library only.
"""
import argparse
import csv
import json
import math
import pathlib
import subprocess
import sys

CASES = pathlib.Path(__file__).resolve().parents[1]
SCENES = {"push": {"corner": "pushed_pile/corner.yaml",
                   "penalty": "pushed_pile/graded_penalty.yaml",
                   "frictional": "pushed_pile/graded_frictional.yaml"},
          "hammer": {"corner": "hammered_pile/corner.yaml",
                     "penalty": "hammered_pile/graded_penalty.yaml",
                     "frictional": "hammered_pile/graded_frictional.yaml"}}
RADIUS = 0.15                       # m, of the pile in both cases
DEPTHS = (0.4, 0.8, 1.2, 1.6)       # m, at which the push is compared
BAND = 0.05                         # m, half of the way over which resistance is averaged
BLOWS = 4                           # first blows whose sets are listed
SURFACE = {"push": 5.0, "hammer": 10.0}  # m, height of the ground
BELOW = 0.09                        # m, of fine cells at least below the last place of the tip
STRIDE = 0.125                      # m, to a multiple of which the fine zone is extended
FIRST_BLOW, PERIOD = 2.0, 0.5       # s, of the hammer
PER_BLOW = 0.75                     # m, of fine cells below the ground for each blow
LEAST, DEEPEST = 1.25, 5.5          # m, of fine cells below the ground
LAST = 12.0                         # s, end of the hammered scenes
# What corner_fine.yaml and the hammered scenes of the other contacts have to save time, for
# corner.yaml; thin rows go in pairs with the corner contact only.
SAVING = ["grid.growth=1.35", "grid.cell_max_m=1", "grid.paired_rows_x_m=0.25",
          "method.noise_damping_per_s=50", "materials.sand.substep_tolerance=0.01",
          "bodies.soil.refine=[{x_m: [0, 0.25], y_m: [0, 10], points_per_cell: 2}]"]


def arguments():
    p = argparse.ArgumentParser(description=__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("study", choices=("push", "hammer"))
    p.add_argument("--out", type=pathlib.Path)
    p.add_argument("--program", default=str(CASES.parent / "build" / "pilewright"))
    p.add_argument("--threads", type=int, default=2)
    p.add_argument("--resolutions", default="1.2,2.4,4.8")
    p.add_argument("--contacts", default="corner,penalty,frictional")
    p.add_argument("--end", help="end_s of every run, or of each resolution; default: the scene's")
    p.add_argument("--set", action="append", default=[], dest="settings")
    a = p.parse_args()
    a.out = a.out or pathlib.Path("out") / f"pile_convergence_{a.study}"
    a.resolutions = [float(r) for r in a.resolutions.split(",")]
    a.contacts = a.contacts.split(",")
    ends = [float(e) for e in a.end.split(",")] if a.end else [None]
    if len(ends) not in (1, len(a.resolutions)):
        p.error("--end: one value, or one for each resolution")
    a.end = dict(zip(a.resolutions, ends if len(ends) > 1 else ends * len(a.resolutions)))
    return a


def fine_zone(study, end):
    """Beside the pile, and down to just below where its tip is at the end of a push at 1 m/s, or
    to where no hammered pile comes that soon."""
    ground = SURFACE[study]
    if study == "push":
        deep = STRIDE * math.ceil((end + BELOW) / STRIDE)
        return ["grid.fine_x_m=[0,0.25]",
                f"grid.fine_y_m=[{ground - deep:g},{ground + STRIDE:g}]"]
    blows = max(1, math.ceil((end - FIRST_BLOW) / PERIOD))
    deep = min(max(PER_BLOW * blows, LEAST), DEEPEST)
    return ["grid.fine_x_m=[0,0.25]", f"grid.fine_y_m=[{ground - deep:g},{ground + 0.25:g}]"]


def settings(contact, resolution, args):
    """What a scene of the case is changed to for one resolution."""
    cell, end = RADIUS / resolution, args.end[resolution]
    sets = [f"grid.cell_m={cell:.9g}"]
    if contact == "penalty":
        sets.append(f"contact_penalty.segment_m={0.4 * cell:.9g}")
    if contact != "corner":
        sets.append(f"bodies.pile.point_size_m={0.4 * cell:.9g}")
    if args.study == "hammer" and contact == "corner":
        sets += SAVING
    if end:
        sets.append(f"time.end_s={end:.9g}")
    if end or args.study == "hammer":
        sets += fine_zone(args.study, end or LAST)
    return sets + args.settings


def expected_s(rows, contact, resolution):
    """Wall time of a run by the finest one before it, of this contact if there is one: points grow
    with the square of the resolution, steps with the resolution."""
    same = [r for r in rows if r["contact"] == contact] or rows
    last = max(same, key=lambda r: r["radius_over_cell"])
    return last["wall_s"] * (resolution / last["radius_over_cell"]) ** 3


def time_left(args, rows):
    """What is still to be run takes about this long, in words; empty before the first run."""
    ahead = [(c, n) for n in args.resolutions for c in args.contacts][len(rows):]
    if not rows:
        return ""
    minutes = sum(expected_s(rows, c, n) for c, n in ahead) / 60
    return f", about {minutes:.0f} min left" if minutes >= 1 else ", less than a minute left"


def run(args, contact, resolution, left):
    """Run one scene unless it has been run; its folder."""
    folder = args.out / f"{contact}_{resolution:g}"
    scene = CASES / SCENES[args.study][contact]
    sets = settings(contact, resolution, args)
    command = [args.program, "run", str(scene), "--out", str(folder), "--threads",
               str(args.threads), "--quiet", "--force"]
    for s in sets:
        command += ["--set", s]
    note = args.out / f"{contact}_{resolution:g}.command"
    text = "\n".join([scene.read_text()] + sets)
    if note.exists() and note.read_text() == text and ended(folder):
        return folder
    print(f"run: {contact} radius/cell {resolution:g}{left}:", " ".join(sets), flush=True)
    for old in (note, folder / "summary.json"):
        old.unlink(missing_ok=True)
    status = subprocess.run(command).returncode
    if not (folder / "summary.json").exists():
        sys.exit(f"converge.py: the scene above was refused at radius/cell {resolution:g}; "
                 "the tables hold what was run before it")
    if status != 0:
        print(f"     ended with status {status}: listed with what it reached", flush=True)
    note.write_text(text)
    return folder


def ended(folder):
    """Ran to its end or failed, so that it would do the same again; not: was interrupted."""
    try:
        return json.loads((folder / "summary.json").read_text())["status"] in ("finished", "failed")
    except (OSError, ValueError, KeyError):
        return False


def history(folder):
    with open(folder / "history.csv", newline="") as f:
        return list(csv.DictReader(f))


def curve(folder):
    """Depth (m) and resistance over base area (kPa) of every row."""
    area = math.pi * RADIUS**2
    return [(float(r["penetration_m"]), 1e-3 * float(r["contact_force_y_n"]) / area)
            for r in history(folder)]


def resistance(rows, depth):
    near = [q for x, q in rows if abs(x - depth) <= BAND]
    return sum(near) / len(near) if near and rows[-1][0] >= depth + 0.9 * BAND else math.nan


def overlap(contact, results):
    """Depth of the deepest soil point; of the deepest corner of a domain with corner contact."""
    key = "contact_overlap_max_m" if contact == "corner" else "largest_overlap_m"
    return results.get(key, math.nan)


def measure(args, contact, resolution, folder):
    """One line of the table."""
    s = json.loads((folder / "summary.json").read_text())
    r, e = s["results"], s["energy"]
    row = {"contact": contact, "radius_over_cell": resolution, "status": s["status"],
           "points": s["points"], "steps": s["steps"], "wall_s": s["wall_s"],
           "sim_time_s": s["sim_time_s"],
           "overlap_over_radius": overlap(contact, r) / RADIUS,
           "energy_error_over_work": abs(e["balance_error_j"]) / max(abs(e["external_work_j"]), 1)}
    if args.study == "push":
        rows = curve(folder)
        for d in DEPTHS:
            row[f"resistance_{d:g}_m_kpa"] = resistance(rows, d)
    else:
        row["penetration_after_gravity_m"] = r.get("penetration_after_gravity_m", math.nan)
        sets = r.get("set_per_blow_m") or []
        for k in range(BLOWS):
            row[f"set_{k + 1}_m"] = sets[k] if k < len(sets) else math.nan
        row["penetration_m"] = r.get("penetration_m", math.nan)
    return row


def write_tables(out, rows):
    with open(out / "table.csv", "w", newline="") as f:
        w = csv.DictWriter(f, rows[0].keys())
        w.writeheader()
        w.writerows(rows)
    width = [max(len(k), 10) for k in rows[0]]
    lines = ["  ".join(k.rjust(n) for k, n in zip(rows[0], width))]
    for row in rows:
        cells = [f"{v:.4g}" if isinstance(v, float) else str(v) for v in row.values()]
        lines.append("  ".join(c.rjust(n) for c, n in zip(cells, width)))
    (out / "table.txt").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


def gnuplot(out, name, title, xlabel, ylabel, lines, extra=""):
    """lines: (title, gnuplot's style, [(x, y), ...])"""
    script = [f'set terminal pngcairo size 900,640 font ",11"', f"set output '{out / name}'",
              f'set title "{title}"', f'set xlabel "{xlabel}"', f'set ylabel "{ylabel}"',
              "set grid", "set key outside right", extra]
    lines = [(t, s, [p for p in pts if not any(math.isnan(v) for v in p)]) for t, s, pts in lines]
    lines = [line for line in lines if line[2]]
    if not lines:
        return
    script.append("plot " + ", ".join(
        f"'-' with linespoints {s} pointsize {0.9 if len(p) < 20 else 0} title \"{t}\""
        for t, s, p in lines))
    for _, _, pts in lines:
        script += [f"{x:.9g} {y:.9g}" for x, y in pts] + ["e"]
    try:
        subprocess.run(["gnuplot"], input="\n".join(script), text=True, check=True)
    except (OSError, subprocess.CalledProcessError) as problem:
        print(f"no plot {name}: {problem}", file=sys.stderr)


def compared(args):
    """Columns whose convergence is plotted."""
    if args.study == "push":
        return [f"resistance_{d:g}_m_kpa" for d in DEPTHS]
    return ["penetration_after_gravity_m", "set_1_m", "penetration_m"]


def style(names, name, kind, kinds):
    """A colour for each name, dashes and points for each kind."""
    return (f"linecolor {names.index(name) + 1} linewidth 1.5 dashtype {kinds.index(kind) + 1} "
            f"pointtype {2 * kinds.index(kind) + 5}")


def plots(args, rows, folders):
    unit = "resistance / base area, kPa" if args.study == "push" else "m"
    series = [(c, key) for c in args.contacts for key in compared(args)]
    for name, x, label in (("convergence.png", "radius_over_cell", "pile radius / cell"),
                           ("time.png", "wall_s", f"wall time on {args.threads} threads, s")):
        gnuplot(args.out, name, f"pile {args.study}: {unit}", label, unit,
                [(f"{c}, {key}".replace("_", " "), style(args.contacts, c, key, compared(args)),
                  [(r[x], r[key]) for r in rows if r["contact"] == c]) for c, key in series],
                "set logscale x 2" if name == "convergence.png" else "set logscale x")
    if args.study == "push":
        gnuplot(args.out, "resistance.png", "pile pushed at 1 m/s",
                "resistance / base area, kPa", "depth of the tip, m",
                [(f"{c} {n:g}", style(args.contacts, c, n, args.resolutions),
                  [(q, d) for d, q in curve(f)]) for (c, n), f in folders.items()],
                "set yrange [*:*] reverse")
    else:
        gnuplot(args.out, "penetration.png", "hammered pile", "time, s", "penetration, m",
                [(f"{c} {n:g}", style(args.contacts, c, n, args.resolutions),
                  [(float(r["time_s"]), float(r["penetration_m"])) for r in history(f)])
                 for (c, n), f in folders.items()],
                "set yrange [*:*] reverse")


def main():
    args = arguments()
    args.out.mkdir(parents=True, exist_ok=True)
    rows, folders = [], {}
    for n in args.resolutions:
        for c in args.contacts:
            folders[c, n] = run(args, c, n, time_left(args, rows))
            rows.append(measure(args, c, n, folders[c, n]))
            write_tables(args.out, rows)
    plots(args, rows, folders)
    print(f"in {args.out}: table.csv, table.txt and plots")


main()
