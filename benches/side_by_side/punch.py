#!/usr/bin/env python3
"""A round punch pressed into a slab and dragged along it: CalculiX 2.20 (Debian `calculix-ccx`) and Asperity.

    cargo build --release
    python3 benches/side_by_side/punch.py [--directory DIR] [--times 3] [--refine 1] [--only-ours]

Two elastic bodies of hex8, friction 0.3, the same meshes, penalty and 31 equal increments: 6 down, 25 along. Both programs
run one thread each, one after the other, several times; user and system time of the processes are compared by their medians.
CalculiX takes face-to-face contact with linear pressure-overclosure and the same slope for sticking. Both solids are
neo-Hookean: CalculiX' `*ELASTIC` is linear in Green's strain at large strain, which softens under pressure and bears a
fifth less here.
"""
import argparse
import csv
import json
import pathlib
import re
import statistics
import sys

from side_by_side import timed

FRICTION, PENALTY = 0.3, 1e5
# Shear and bulk moduli of slab and punch, for a Poisson's ratio of 0.3.
MODULI = [(young / 2.6, young / 1.2) for young in (1e3, 1e4)]
RADIUS, DOWN, ALONG, PRESS, DRAG = 2.0, 0.2, 1.5, 6, 25


def lattice(cells, place, first):
    """Nodes and hexahedra of a box of cells, numbered from `first`."""
    n = [c + 1 for c in cells]
    number = lambda i, j, k: first + i + n[0] * (j + n[1] * k)
    nodes = [(number(i, j, k), place(i / cells[0], j / cells[1], k / cells[2]))
             for k in range(n[2]) for j in range(n[1]) for i in range(n[0])]
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    hexes = [[number(i + a, j + b, k + c) for a, b, c in corners]
             for k in range(cells[2]) for j in range(cells[1]) for i in range(cells[0])]
    return nodes, hexes


def sole(x, y):
    """Height of the sphere's lowest part."""
    return RADIUS - (RADIUS**2 - x**2 - y**2) ** 0.5


def bodies(refine):
    """The slab below z = 0 and the punch above: nodes, cells, layers along z."""
    slab_cells, punch_cells = [c * refine for c in (20, 10, 5)], [c * refine for c in (8, 8, 4)]
    slab = lattice(slab_cells, lambda s, t, r: (6 * s - 1.5, 3 * t - 1.5, 1.5 * (r - 1)), 1)

    def punch(s, t, r):
        x, y = 1.6 * s - 0.8, 1.6 * t - 0.8
        low = sole(x, y)
        return x, y, low + (1 - low) * r + 1e-4

    return (slab, slab_cells), (lattice(punch_cells, punch, len(slab[0]) + 1), punch_cells)


# Faces of a hexahedron at the least and the largest z, outward.
LOW, HIGH = (0, 3, 2, 1), (4, 5, 6, 7)


def layer(body, top):
    """Cells of the lowest or the highest layer, by their places in the list."""
    (_, hexes), cells = body
    count = cells[0] * cells[1]
    return range(len(hexes) - count, len(hexes)) if top else range(count)


def write_ours(folder, refine):
    slab, punch = bodies(refine)
    groups = [("slab", slab, None), ("punch", punch, None), ("floor", slab, (False, LOW)), ("track", slab, (True, HIGH)),
              ("sole", punch, (False, LOW)), ("head", punch, (True, HIGH))]
    rows = []
    for number, (_, body, side) in enumerate(groups, 1):
        hexes = body[0][1]
        if side is None:
            rows += [(5, number, cell) for cell in hexes]
        else:
            rows += [(3, number, [hexes[e][k] for k in side[1]]) for e in layer(body, side[0])]
    nodes = slab[0][0] + punch[0][0]
    names = [f'{2 if side else 3} {n} "{name}"' for n, (name, _, side) in enumerate(groups, 1)]
    mesh = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names)), *names, "$EndPhysicalNames"]
    mesh += ["$Nodes", str(len(nodes)), *(f"{n} {x:.12f} {y:.12f} {z:.12f}" for n, (x, y, z) in nodes), "$EndNodes"]
    mesh += ["$Elements", str(len(rows))]
    mesh += [f"{n} {kind} 2 {g} {g} {' '.join(map(str, cell))}" for n, (kind, g, cell) in enumerate(rows, 1)]
    (folder / "punch.msh").write_text("\n".join(mesh + ["$EndElements", ""]))
    (folder / "punch.toml").write_text(f"""version = 1
title = "Round punch dragged along a slab"
space = "solid"
mesh.file = "punch.msh"
material.soft.neo_hookean = {{ shear = {MODULI[0][0]}, bulk = {MODULI[0][1]} }}
material.stiff.neo_hookean = {{ shear = {MODULI[1][0]}, bulk = {MODULI[1][1]} }}
body.slab.material = "soft"
body.punch.material = "stiff"
[contact.joint]
surface = "track"
target = "sole"
law.coulomb.friction = {FRICTION}
penalty = {PENALTY}
[[step]]
displacement.floor = {{ x = 0.0, y = 0.0, z = 0.0 }}
displacement.head = {{ x = 0.0, y = 0.0, z = -{DOWN} }}
increments.count = {PRESS}
[[step]]
displacement.head = {{ x = {ALONG}, y = 0.0, z = -{DOWN} }}
increments.count = {DRAG}
""")


def write_theirs(folder, refine):
    slab, punch = bodies(refine)
    law = lambda shear, bulk: f"*HYPERELASTIC, NEO HOOKE\n{shear / 2}, {2 / bulk}"
    lines = ["*NODE, NSET=NALL"] + [f"{n}, {x:.12f}, {y:.12f}, {z:.12f}" for n, (x, y, z) in slab[0][0] + punch[0][0]]
    first = 1
    starts = []
    for name, body in (("SLAB", slab), ("PUNCH", punch)):
        hexes = body[0][1]
        starts.append(first)
        lines += [f"*ELEMENT, TYPE=C3D8, ELSET={name}"] + [f"{e}, {', '.join(map(str, h))}" for e, h in enumerate(hexes, first)]
        first += len(hexes)
    # Faces 1 and 2 of CalculiX are the lower and the upper one.
    lines += ["*SURFACE, NAME=TRACK, TYPE=ELEMENT"] + [f"{starts[0] + e}, S2" for e in layer(slab, True)]
    lines += ["*SURFACE, NAME=SOLE, TYPE=ELEMENT"] + [f"{starts[1] + e}, S1" for e in layer(punch, False)]
    count = lambda body: (body[1][0] + 1) * (body[1][1] + 1)
    lines += ["*NSET, NSET=FLOOR"] + [f"{n}," for n, _ in slab[0][0][:count(slab)]]
    lines += ["*NSET, NSET=HEAD"] + [f"{n}," for n, _ in punch[0][0][-count(punch):]]
    step = lambda increments, x: f"""*STEP, NLGEOM, INC=1000
*STATIC, DIRECT
{1 / increments:.12f}, 1.
*BOUNDARY
FLOOR, 1, 3
HEAD, 1, 1, {x}
HEAD, 2, 2
HEAD, 3, 3, -{DOWN}
*NODE PRINT, NSET=HEAD, TOTALS=ONLY
RF
*NODE FILE
U
*EL FILE
S
*END STEP
"""
    (folder / "punch.inp").write_text("\n".join(lines) + f"""
*MATERIAL, NAME=SOFT
{law(*MODULI[0])}
*MATERIAL, NAME=STIFF
{law(*MODULI[1])}
*SOLID SECTION, ELSET=SLAB, MATERIAL=SOFT
*SOLID SECTION, ELSET=PUNCH, MATERIAL=STIFF
*SURFACE INTERACTION, NAME=FILM
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
{PENALTY}
*FRICTION
{FRICTION}, {PENALTY}
*CONTACT PAIR, INTERACTION=FILM, TYPE=SURFACE TO SURFACE
TRACK, SOLE
""" + step(PRESS, 0.0) + step(DRAG, ALONG))


def run_ours(program, folder, refine):
    folder.mkdir(parents=True, exist_ok=True)
    write_ours(folder, refine)
    seconds, code = timed([program, "run", "punch.toml", "--out", "results", "--threads", "1"], folder)
    with open(folder / "results" / "history.csv") as table:
        rows = list(csv.DictReader(table))
    force = [(float(row["reaction.head.x"]), float(row["reaction.head.z"])) for row in rows]
    summary = json.loads((folder / "results" / "summary.json").read_text())
    return seconds, force, summary["iterations"], code


def run_theirs(folder, refine):
    folder.mkdir(parents=True, exist_ok=True)
    write_theirs(folder, refine)
    seconds, code = timed(["ccx", "punch"], folder)
    numbers = [line.split() for line in (folder / "punch.dat").read_text().splitlines() if line.strip()]
    force = [(float(row[0]), float(row[2])) for row in numbers if re.fullmatch(r"-?\d.*", row[0]) and len(row) == 3]
    iterations = len(re.findall(r"^ iteration \d+$", (folder / "out.txt").read_text(), re.MULTILINE))
    return seconds, force, iterations, code


def tell(name, runs):
    seconds = [run[0] for run in runs]
    _, force, iterations, code = runs[-1]
    told = ", ".join(f"{s:.2f}" for s in seconds)
    pressed, dragged = (force[PRESS - 1], force[-1]) if len(force) == PRESS + DRAG else ((0, 0), (0, 0))
    print(f"{name:10} {statistics.median(seconds):8.2f} s (of {told}), {iterations} iterations in {len(force)} increments, exit "
          f"{code}, force down {-pressed[1]:.2f} pressed, {-dragged[1]:.2f} dragged, along {dragged[0]:.2f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--directory", type=pathlib.Path, default=pathlib.Path("target/side_by_side"))
    parser.add_argument("--times", type=int, default=3)
    parser.add_argument("--refine", type=int, default=1)
    parser.add_argument("--only-ours", action="store_true")
    options = parser.parse_args()
    root = pathlib.Path(__file__).resolve().parents[2]
    program, where = str(root / "target/release/asperity"), options.directory.resolve()
    ours, theirs = [], []
    for _ in range(options.times):
        ours.append(run_ours(program, where / "punch_asperity", options.refine))
        if not options.only_ours:
            theirs.append(run_theirs(where / "punch_calculix", options.refine))
    tell("Asperity", ours)
    if theirs:
        tell("CalculiX", theirs)
        medians = [statistics.median(run[0] for run in runs) for runs in (theirs, ours)]
        print(f"ratio of the medians {medians[0] / medians[1]:.1f}")
    return 0 if all(run[3] == 0 for run in ours + theirs) else 1


if __name__ == "__main__":
    sys.exit(main())
