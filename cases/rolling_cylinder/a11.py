#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The figures of a rigid cylinder (verification A11) beside those of the penalty contact.

usage: a11.py [--only rigid,soft,equal] [--cell M] [--mass-terms N] [--out DIR] [--program FILE]
              [--jobs N]

USL with two terms of the mass matrix; segments of a quarter of a cell, lines without mass; gravity
turns over 0.6 s, so that the cylinder does not bounce. Rolling (45 degrees) and sliding (60
degrees), each with

rigid: bodies and contact ten times as stiff as the thesis', cells of 0.1 m. Some 5 minutes a run.
soft:  the thesis' bodies, cells of 0.16 m to roll and of 0.08 m to slide; 30 s and 4 minutes. An
       elastic cylinder has other figures than a rigid one, which finer cells bring out: README.
equal: the plane as soft as the cylinder, so that friction does not shift the normal pressure.

Exit status 1 if a figure of the rigid or the soft cylinder is outside its tolerance. Of the soft one
the angle of fitted accelerations counts; the one with the start is printed beside it.
Python's standard library only.
"""
import argparse
import concurrent.futures
import math
import pathlib
import subprocess
import sys

sys.dont_write_bytecode = True  # no cache in the case's folder
import fit  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
TURN = 0.6  # s, some two periods of the soft cylinder on its contact
# scene, tilt, friction, tolerances of fitted acceleration, turning and mean normal force
MOTIONS = [("penalty_no_slip", 45.0, 0.495, (0.01, 0.005, 0.005)),
           ("penalty_slip", 60.0, 0.286, (0.01, 0.02, 0.005))]
SOFT_CELLS = {"penalty_no_slip": 0.16, "penalty_slip": 0.08}  # m; others have 0.1
# bulk modulus of cylinder and plane, Pa (the shear modulus is half of it); contact stiffness, Pa/m
BODIES = {"rigid": (6e7, 6e8, 1e9), "soft": (6e6, 6e7, 1e8), "equal": (6e6, 6e6, 1e8)}


def arguments():
    p = argparse.ArgumentParser(description=__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--only", default="soft,rigid", help="of rigid, soft, equal (%(default)s)")
    p.add_argument("--cell", type=float, help="m (0.1; soft 0.16 and 0.08)")
    p.add_argument("--mass-terms", type=int, default=2, help="of method.mass_terms (%(default)s)")
    p.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/a11"))
    p.add_argument("--program", default=str(HERE.parents[1] / "build" / "pilewright"))
    p.add_argument("--jobs", type=int, default=2, help="runs at a time, one thread each")
    a = p.parse_args()
    a.only = a.only.split(",")
    unknown = [name for name in a.only if name not in BODIES]
    if unknown:
        p.error(f"--only: no bodies '{unknown[0]}'; there are {', '.join(BODIES)}")
    return a


def settings(bodies, cell, terms):
    rubber, rock, contact = BODIES[bodies]
    keys = {"method.update": "usl", "method.mass_terms": terms, "grid.cell_m": cell, "contact_penalty.segment_m": cell / 4,
            "contact_penalty.thickness_m": 0, "gravity.tilt_over_s": TURN,
            "contact_penalty.normal_stiffness_pa_m": contact,
            "contact_penalty.tangential_stiffness_pa_m": contact,
            "output.snapshot_every_s": 4, "output.picture_times_s": "[]"}
    for name in ("cylinder", "plane"):  # three to a cell and direction
        keys[f"bodies.{name}.point_size_m"] = cell * 0.335
    for name, bulk in (("rubber", rubber), ("rock", rock)):
        keys[f"materials.{name}.bulk_modulus_pa"] = bulk
        keys[f"materials.{name}.shear_modulus_pa"] = 0.5 * bulk
    return [word for k, v in keys.items() for word in ("--set", f"{k}={v}")]


def run(a, bodies, scene):
    folder = a.out / f"{bodies}_{scene}"
    cell = a.cell or (SOFT_CELLS[scene] if bodies == "soft" else 0.1)
    command = [a.program, "run", str(HERE / f"{scene}.yaml"), "--out", str(folder), "--force",
               "--quiet", "--threads", "1", *settings(bodies, cell, a.mass_terms)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(command)}\n{done.stderr}")
    return folder


def pressure_ahead(half, both, beta, friction, stiffness, pieces=120):
    """How far ahead of the centre the normal force on a sliding elastic cylinder stands; m. Pieces of
    constant pressure p on its skin, of which those that touch follow from

        -2 / (pi E*) int p(s) ln|x - s| ds - beta friction / E* int p(s) sign(x - s) ds
            + p / stiffness = depth - x^2 / (2 R)

    (Johnson, Contact Mechanics, 1985, section 7.2, with the springs of the contact in series). Without
    springs it is 8 k half / 3 with tan(pi k) = friction beta."""
    force = math.pi * both * half**2 / (4.0 * fit.RADIUS)
    width = 3.2 * half / pieces
    place = [(i + 0.5) * width - 1.6 * half for i in range(pieces)]

    def sunk(near, far):
        logs = [z * (math.log(abs(z)) - 1.0) for z in (near + 0.5 * width, near - 0.5 * width)]
        turn = beta * friction / both * math.copysign(width, near) if far else 0.0
        return -2.0 / (math.pi * both) * (logs[0] - logs[1]) - turn

    down = [[sunk(x - s, i != j) for j, s in enumerate(place)] for i, x in enumerate(place)]
    touching = [i for i in range(pieces) if abs(place[i]) < 1.05 * half]
    while True:
        rows = [[down[i][j] + (1.0 / stiffness if i == j else 0.0) for j in touching] + [-1.0]
                for i in touching] + [[width] * len(touching) + [0.0]]
        *press, depth = fit.solve(rows, [-place[i]**2 / (2.0 * fit.RADIUS) for i in touching]
                                  + [force])
        p = dict(zip(touching, press))
        now = [i for i in range(pieces)
               if (p[i] > 0.0 if i in p else sum(down[i][j] * p[j] for j in p)
                   < depth - place[i]**2 / (2.0 * fit.RADIUS))]
        if now == touching:
            return sum(p[i] * place[i] for i in p) / sum(p.values())
        touching = now


def elastic_missing(bodies, tilt, friction):
    """Moment that a sliding elastic cylinder lacks, over the normal force (m): how far that force
    stands ahead, and friction times what the arm is shorter (Johnson, section 5.6). Plane strain."""
    def shear_and_poisson(bulk):
        return 0.5 * bulk, 2.0 / 7.0  # K = 2 G in three dimensions

    rubber, rock, stiffness = BODIES[bodies]
    (g1, nu1), (g2, nu2) = shear_and_poisson(rubber), shear_and_poisson(rock)
    stiff = g1 * 2.0 / (1.0 - nu1)  # E / (1 - nu^2) of the cylinder
    both = 1.0 / (1.0 / stiff + (1.0 - nu2) / (2.0 * g2))
    beta = (0.5 * ((1.0 - 2.0 * nu1) / g1 - (1.0 - 2.0 * nu2) / g2)
            / ((1.0 - nu1) / g1 + (1.0 - nu2) / g2))
    force = fit.DENSITY * math.pi * fit.RADIUS**2 * fit.GRAVITY * math.cos(math.radians(tilt))
    half = math.sqrt(4.0 * force * fit.RADIUS / (math.pi * both))  # of the strip without springs
    shorter = force / (math.pi * stiff) * (2.0 * math.log(4.0 * fit.RADIUS / half) - 1.0)
    return pressure_ahead(half, both, beta, friction, stiffness), friction * shorter


def report(bodies, motion, folder):
    """Print a run's figures; whether all that have a tolerance are within it."""
    scene, tilt, friction, (speed, turn, push) = motion
    f = fit.fitted(str(folder), tilt, friction, TURN)
    figures = [("fitted acceleration", f["a"] / f["exact_a"], speed),
               ("turned angle over way", f["late_turning"] / f["exact_late_turning"], turn),
               ("mean normal force", f["push"], push)]
    whole = ("the same with the start", f["turning"] / f["exact_turning"], turn)
    counted = figures + [whole] * (bodies == "rigid")
    for what, ratio, tolerance in figures + [whole]:
        out = abs(ratio - 1.0) > tolerance
        print(f"{bodies:6} {scene:16} {what:23} {ratio:.4f}  1 +- {tolerance:<6g}"
              f"{' outside' if out else ''}")
    low, high = f["push_range"]
    print(f"{bodies:6} {scene:16} normal force {low:.2f} to {high:.2f} of m g cos(tilt); "
          f"moment missing {1e3 * f['offset_m']:.1f} mm x normal force")
    if scene == "penalty_slip":
        ahead, shorter = elastic_missing(bodies, tilt, friction)
        print(f"{bodies:6} {scene:16} of which by elasticity: normal force ahead "
              f"{1e3 * ahead:.2f} mm, shorter arm {1e3 * shorter:.2f} mm")
    sys.stdout.flush()
    return all(abs(ratio - 1.0) <= tolerance for _, ratio, tolerance in counted)


def main():
    a = arguments()
    good = True
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        pending = [(bodies, motion, pool.submit(run, a, bodies, motion[0]))
                   for bodies in a.only for motion in MOTIONS]
        try:
            for bodies, motion, folder in pending:
                within = report(bodies, motion, folder.result())
                good = good and (within or bodies == "equal")
        except RuntimeError as failed:
            pool.shutdown(wait=False, cancel_futures=True)
            sys.exit(str(failed))
    sys.exit(0 if good else 1)


main()
