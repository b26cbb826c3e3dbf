#!/usr/bin/env python3
"""One tube, two programs: CalculiX 2.20 (Debian `calculix-ccx`) and Asperity.

    cargo build --release
    python3 benches/side_by_side/side_by_side.py [--directory DIR] [--times 3] [--only-ours]

The tube of `cases/tube` (bore 50, outer radius 55, length 150, steel, axisymmetric, no friction) is pushed 100 mm over a
step of 3 mm: 8 x 160 elements of first degree, 70 equal increments, the same penalty. Both programs run one thread
each, one after the other, several times; user and system time of the processes are compared by their medians, and the
last force by that of our own mesh refined twice. CalculiX has no rigid profile: its tool is a row of elements whose
nodes are all held, 16 to an arc.

CalculiX pairs node to face here, its faster and more accurate way for this tube; `--surface` takes face to face.
Elastic laws differ under finite strain (CalculiX: Green's strain; here: Jaumann rate, which integrates to logarithmic
strain in a tube): at 6 per cent of hoop strain its energy, and so its force, lies 12 per cent higher. CalculiX reports forces of an axisymmetric model for two degrees of the circumference.
"""
import argparse
import csv
import json
import math
import os
import pathlib
import re
import statistics
import subprocess
import sys

BORE, OUTER, LENGTH, STEP, TRAVEL = 50.0, 55.0, 150.0, 3.0, 100.0
YOUNG, NU, ANGLE, FILLET = 210e3, 0.3, math.radians(10), 10.0
THROUGH, ALONG, INCREMENTS = 8, 160, 70
PENALTY = 50 * YOUNG / ((OUTER - BORE) / THROUGH)


def arc(centre, start, end, pieces):
    """Points of an arc of the fillet's radius between two directions in degrees."""
    turn = [math.radians(start + (end - start) * i / pieces) for i in range(pieces + 1)]
    return [(centre[0] + FILLET * math.cos(t), centre[1] + FILLET * math.sin(t)) for t in turn]


def fillets(pieces):
    """The arcs below and above the cone, each from below upwards."""
    rise = FILLET * (1 - math.cos(ANGLE))
    height = (STEP - 2 * rise) / math.tan(ANGLE) + 2 * FILLET * math.sin(ANGLE)
    lower = arc((BORE + STEP - FILLET, -height), 0, 10, pieces)
    upper = arc((BORE + FILLET, 0.0), 190, 180, pieces)
    return lower, upper


def profile(pieces):
    """The tool from below upwards, its material on the left."""
    lower, upper = fillets(pieces)
    return [(BORE + STEP, -LENGTH)] + lower + upper + [(BORE, LENGTH + 50)]


def pair(point):
    return f"[{point[0]:.12f}, {point[1]:.12f}]"


def asperity_deck(refine):
    """Our deck; `refine` divides every element and increment."""
    lower, upper = fillets(2)
    line = lambda a, b: f"    {{ line = [{pair(a)}, {pair(b)}] }},"
    bend = lambda p: f"    {{ arc = [{', '.join(map(pair, p))}] }},"
    points = profile(2)
    segments = [line(points[0], lower[0]), bend(lower), line(lower[-1], upper[0]), bend(upper), line(upper[-1], points[-1])]
    return f"""version = 1
title = "Tube over a step of 3 mm"
space = "axisymmetric"
[mesh.part.tube.rectangle]
from = [{BORE}, 0.0]
to = [{OUTER}, {LENGTH}]
cells = [{THROUGH * refine}, {ALONG * refine}]
cell = "quad4"
[material.steel.elastic]
young = {YOUNG}
poisson = {NU}
[body.tube]
material = "steel"
[tool.mandrel]
profile = [
{chr(10).join(segments)}
]
[contact.bore]
surface = "tube.left"
target = "mandrel"
law.coulomb.friction = 0.0
penalty = {PENALTY}
[[step]]
increments.count = {INCREMENTS * refine}
displacement."tube.top" = {{ y = -{TRAVEL} }}
"""


def grid(across, along, point, first):
    """Nodes and quadrilaterals of a grid, numbered from `first`, rows along the second direction."""
    nodes = [(first + i + j * (across + 1), *point(i, j)) for j in range(along + 1) for i in range(across + 1)]
    cell = lambda i, j: first + i + j * (across + 1)
    cells = [(cell(i, j), cell(i + 1, j), cell(i + 1, j + 1), cell(i, j + 1)) for j in range(along) for i in range(across)]
    return nodes, cells


def calculix_deck(kind):
    """The deck of CalculiX."""
    size = ((OUTER - BORE) / THROUGH, LENGTH / ALONG)
    tube, quads = grid(THROUGH, ALONG, lambda i, j: (BORE + i * size[0], j * size[1]), 1)
    outline = profile(16)
    tool, rows = grid(1, len(outline) - 1, lambda i, j: (outline[j][0] - 5.0 * (1 - i), outline[j][1]), len(tube) + 1)
    lines = ["*NODE, NSET=NALL"] + [f"{n}, {x:.12f}, {y:.12f}, 0." for n, x, y in tube + tool]
    lines += ["*ELEMENT, TYPE=CAX4, ELSET=TUBE"] + [f"{e}, {', '.join(map(str, q))}" for e, q in enumerate(quads, 1)]
    first = len(quads) + 1
    lines += ["*ELEMENT, TYPE=CAX4, ELSET=TOOL"] + [f"{e}, {', '.join(map(str, q))}" for e, q in enumerate(rows, first)]
    top = [n for n, _, y in tube if y > LENGTH - 1e-9]
    lines += ["*NSET, NSET=TOP"] + [f"{n}," for n in top]
    lines += ["*NSET, NSET=HELD"] + [f"{n}," for n, *_ in tool]
    # Face 4 of a quadrilateral is its left side, face 2 its right one.
    lines += ["*SURFACE, NAME=BORE, TYPE=ELEMENT"] + [f"{1 + j * THROUGH}, S4" for j in range(ALONG)]
    lines += ["*SURFACE, NAME=FACE, TYPE=ELEMENT"] + [f"{first + j}, S2" for j in range(len(rows))]
    return "\n".join(lines) + f"""
*MATERIAL, NAME=STEEL
*ELASTIC
{YOUNG}, {NU}
*SOLID SECTION, ELSET=TUBE, MATERIAL=STEEL
*SOLID SECTION, ELSET=TOOL, MATERIAL=STEEL
*SURFACE INTERACTION, NAME=FILM
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
{PENALTY}
*CONTACT PAIR, INTERACTION=FILM, TYPE={kind}
BORE, FACE
*STEP, NLGEOM, INC=1000
*STATIC, DIRECT
{1 / INCREMENTS:.12f}, 1.
*BOUNDARY
HELD, 1, 2
TOP, 2, 2, -{TRAVEL}
*NODE PRINT, NSET=TOP, TOTALS=ONLY
RF
*NODE FILE
U
*EL FILE
S
*END STEP
"""


def timed(command, directory):
    """User and system seconds of a process of one thread."""
    environment = dict(os.environ, OMP_NUM_THREADS="1", CCX_NPROC_EQUATION_SOLVER="1", NUMBER_OF_CPUS="1")
    with open(directory / "out.txt", "w") as out:
        process = subprocess.Popen(command, cwd=directory, env=environment, stdout=out, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return usage.ru_utime + usage.ru_stime, process.returncode


def run_ours(program, directory, refine):
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "tube.toml").write_text(asperity_deck(refine))
    seconds, code = timed([program, "run", "tube.toml", "--out", "results", "--threads", "1"], directory)
    with open(directory / "results" / "history.csv") as table:
        force = [(float(row["time"]), float(row["contact.bore.force.y"])) for row in csv.DictReader(table)]
    return seconds, force, json.loads((directory / "results" / "summary.json").read_text())["iterations"], code


def run_calculix(directory, kind):
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "tube.inp").write_text(calculix_deck(kind))
    seconds, code = timed(["ccx", "tube"], directory)
    force, time = [], None
    for line in (directory / "tube.dat").read_text().splitlines():
        if "time" in line:
            time = float(line.split()[-1])
        elif time is not None and len(line.split()) == 3:
            force.append((time, -180 * float(line.split()[1])))
    iterations = len(re.findall(r"^ iteration \d+$", (directory / "out.txt").read_text(), re.MULTILINE))
    return seconds, force, iterations, code


def steady(force):
    """Mean force over the last two fifths of the travel."""
    values = [f for time, f in force if time > 0.6]
    return statistics.fmean(values) if values else math.nan


def tell(name, runs):
    seconds = [run[0] for run in runs]
    _, force, iterations, code = runs[-1]
    told = ", ".join(f"{s:.2f}" for s in seconds)
    print(f"{name:22} {statistics.median(seconds):8.2f} s (of {told}), {iterations} iterations, exit {code}, "
          f"to time {force[-1][0] if force else 0:.3f}, mean force {steady(force) / 1e3:.2f} kN")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--directory", type=pathlib.Path, default=pathlib.Path("target/side_by_side"))
    parser.add_argument("--times", type=int, default=3)
    parser.add_argument("--surface", action="store_true")
    parser.add_argument("--only-ours", action="store_true")
    options = parser.parse_args()
    root = pathlib.Path(__file__).resolve().parents[2]
    program, where = str(root / "target/release/asperity"), options.directory.resolve()
    kind = "SURFACE TO SURFACE" if options.surface else "NODE TO SURFACE"
    ours, theirs = [], []
    for _ in range(options.times):
        ours.append(run_ours(program, where / "asperity", 1))
        if not options.only_ours:
            theirs.append(run_calculix(where / "calculix", kind))
    tell("Asperity", ours)
    if theirs:
        tell(f"CalculiX {kind.lower()}", theirs)
        medians = [statistics.median(run[0] for run in runs) for runs in (theirs, ours)]
        print(f"ratio of the medians   {medians[0] / medians[1]:8.1f}")
    fine = run_ours(program, where / "refined", 4)
    tell("Asperity, refined twice", [fine])
    print(f"our mean force over that of the refined run: {steady(ours[-1][1]) / steady(fine[1]) - 1:+.3%}")
    return 0 if all(run[3] == 0 for run in ours + theirs) else 1


if __name__ == "__main__":
    sys.exit(main())
