#!/usr/bin/env python3
"""A cube, an upset cube and Hertz' sphere: CalculiX 2.20 (Debian `calculix-ccx`) and Asperity.

    cargo build --release
    python3 benches/side_by_side/bodies.py [--directory DIR] [--times 1] [cube] [upsetting] [sphere]

The same meshes and equal increments; both programs run one thread each, one after the other, and user and system time of the
processes are compared by their medians.

- `cube`: a neo-Hookean cube of 23^3 hex8 (41 472 unknowns) between two faces, pressed by a fifth and sheared by a tenth, four
  increments.
- `upsetting`: an eighth of a cube of 12^3 hex8 of hardening steel, upset by three tenths against a plate with friction .2 in 12
  increments; both with plain eight-point cells. CalculiX' plate is a layer of cells whose nodes are all held.
- `sphere`: a sphere against a rigid plane, axisymmetric, quadrilaterals of eight nodes with reduced integration, about 13 000
  unknowns, no friction, small strain, ten increments to a contact radius of about a tenth of its own.
"""
import argparse
import csv
import json
import math
import pathlib
import re
import statistics
import sys

from punch import HIGH, LOW, lattice, layer
from side_by_side import timed

RUNS = {}


def run(function):
    RUNS[function.__name__] = function
    return function


def gmsh(nodes, groups, kinds):
    """A mesh of named groups of cells: `kinds` says Gmsh's number of the shape and its dimension."""
    names = [f'{kinds[shape][1]} {n} "{name}"' for n, (name, shape, _) in enumerate(groups, 1)]
    rows = [(kinds[shape][0], n, cell) for n, (_, shape, cells) in enumerate(groups, 1) for cell in cells]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names)), *names, "$EndPhysicalNames"]
    lines += ["$Nodes", str(len(nodes)), *(f"{n} {x:.12f} {y:.12f} {z:.12f}" for n, (x, y, z) in nodes), "$EndNodes"]
    lines += ["$Elements", str(len(rows))]
    lines += [f"{n} {kind} 2 {g} {g} {' '.join(map(str, cell))}" for n, (kind, g, cell) in enumerate(rows, 1)]
    return "\n".join(lines + ["$EndElements", ""])


SHAPES = {"hex8": (5, 3), "quad4": (3, 2), "quad8": (16, 2), "line3": (8, 1)}


def listed(keyword, numbers):
    return [keyword] + [f"{n}," for n in numbers]


def elements(kind, name, cells, first=1):
    """Rows of 16 numbers at the most, as CalculiX reads them."""
    return [f"*ELEMENT, TYPE={kind}, ELSET={name}"] + [f"{e}, {', '.join(map(str, c))}" for e, c in enumerate(cells, first)]


def node_rows(nodes):
    return ["*NODE, NSET=NALL"] + [f"{n}, {x:.12f}, {y:.12f}, {z:.12f}" for n, (x, y, z) in nodes]


def steps(increments, boundary, printed, geometry=", NLGEOM"):
    return f"""
*STEP{geometry}, INC=1000
*STATIC, DIRECT
{1 / increments:.12f}, 1.
*BOUNDARY
{boundary}
*NODE PRINT, NSET={printed}, TOTALS=ONLY
RF
*NODE FILE
U
*EL FILE
S
*END STEP
"""


@run
def cube(size=23):
    shear, bulk = 1.0, 10.0 / 3.0
    nodes, hexes = lattice([size] * 3, lambda s, t, r: (s, t, r), 1)
    top = [n for n, (_, _, z) in nodes if z > 1 - 1e-9]
    body = (nodes, hexes), [size] * 3
    face = lambda up, side: [[hexes[e][k] for k in side] for e in layer(body, up)]
    groups = [("cube", "hex8", hexes), ("low", "quad4", face(False, LOW)), ("high", "quad4", face(True, HIGH))]
    ours = f"""material.rubber.neo_hookean = {{ shear = {shear}, bulk = {bulk} }}
body.cube = {{ material = "rubber", formulation = "standard" }}
[[step]]
increments.count = 4
displacement.low = {{ x = 0.0, y = 0.0, z = 0.0 }}
displacement.high = {{ x = 0.1, y = 0.0, z = -0.2 }}
"""
    low = [n for n, (_, _, z) in nodes if z < 1e-9]
    theirs = node_rows(nodes) + elements("C3D8", "CUBE", hexes) + listed("*NSET, NSET=LOW", low)
    theirs += listed("*NSET, NSET=HIGH", top)
    theirs += ["*MATERIAL, NAME=RUBBER", "*HYPERELASTIC, NEO HOOKE", f"{shear / 2}, {2 / bulk}"]
    theirs += ["*SOLID SECTION, ELSET=CUBE, MATERIAL=RUBBER"]
    held = "LOW, 1, 3\nHIGH, 1, 1, .1\nHIGH, 2, 2\nHIGH, 3, 3, -.2"
    return "solid", gmsh(nodes, groups, SHAPES), ours, "\n".join(theirs) + steps(4, held, "HIGH"), ("reaction.high.z", 2, 1)


@run
def upsetting(size=12, down=3.0, increments=12):
    side = 10.0
    nodes, hexes = lattice([size] * 3, lambda s, t, r: (side * s, side * t, side * r), 1)
    body = (nodes, hexes), [size] * 3
    places = dict(nodes)
    inside = lambda axis, value: [n for n, x in nodes if abs(x[axis] - value) < 1e-9]
    faces = {"left": (0, 0.0, (0, 4, 7, 3)), "front": (1, 0.0, (0, 1, 5, 4)), "low": (2, 0.0, LOW), "high": (2, side, HIGH),
             "right": (0, side, (1, 2, 6, 5)), "back": (1, side, (3, 7, 6, 2))}

    def on(name):
        axis, value, corners = faces[name]
        quads = [[cell[k] for k in corners] for cell in hexes]
        return [quad for quad in quads if all(abs(places[n][axis] - value) < 1e-9 for n in quad)]

    groups = [("cube", "hex8", hexes)] + [(name, "quad4", on(name)) for name in ("left", "front", "low", "high")]
    groups += [("outside", "quad4", on("high") + on("right") + on("back"))]
    ours = f"""material.steel.von_mises = {{ young = 200e3, poisson = 0.3, yield_stress = 400.0, hardening = 500.0 }}
body.cube = {{ material = "steel", formulation = "standard" }}
[tool.plate.plane]
at = [0.0, 0.0, {side}]
normal = [0.0, 0.0, -1.0]
side = {6 * side}
[contact.end]
surface = "outside"
target = "plate"
law.coulomb = {{ friction = 0.2 }}
[[step]]
symmetry = ["left", "front", "low"]
increments.count = {increments}
motion.plate = {{ z = -{down} }}
"""
    plate, cells = lattice([4, 4, 1], lambda s, t, r: (3 * side * s - side, 3 * side * t - side, side + 2 * r), len(nodes) + 1)
    first = len(hexes) + 1
    theirs = node_rows(nodes + plate) + elements("C3D8", "CUBE", hexes) + elements("C3D8", "PLATE", cells, first)
    for name, axis in (("LEFT", 0), ("FRONT", 1), ("FLOOR", 2)):
        theirs += listed(f"*NSET, NSET={name}", inside(axis, 0.0))
    theirs += listed("*NSET, NSET=TOOL", [n for n, _ in plate])
    # Sides 2, 4 and 5 of a cell look along z, x and y.
    at = lambda axis: [e for e, cell in enumerate(hexes, 1) if sum(abs(places[n][axis] - side) < 1e-9 for n in cell) == 4]
    theirs += ["*SURFACE, NAME=OUTSIDE, TYPE=ELEMENT"] + [f"{e}, S2" for e in at(2)] + [f"{e}, S4" for e in at(0)]
    theirs += [f"{e}, S5" for e in at(1)]
    theirs += ["*SURFACE, NAME=FACE, TYPE=ELEMENT"] + [f"{first + e}, S1" for e in range(len(cells))]
    theirs += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "200e3, .3", "*PLASTIC", "400., 0.", "5400., 10."]
    theirs += ["*SOLID SECTION, ELSET=CUBE, MATERIAL=STEEL", "*SOLID SECTION, ELSET=PLATE, MATERIAL=STEEL"]
    theirs += ["*SURFACE INTERACTION, NAME=FILM", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "2e5", "*FRICTION", ".2, 2e4"]
    theirs += ["*CONTACT PAIR, INTERACTION=FILM, TYPE=SURFACE TO SURFACE", "OUTSIDE, FACE"]
    held = f"LEFT, 1, 1\nFRONT, 2, 2\nFLOOR, 3, 3\nTOOL, 1, 2\nTOOL, 3, 3, -{down}"
    return "solid", gmsh(nodes, groups, SHAPES), ours, "\n".join(theirs) + steps(increments, held, "FLOOR"), ("reaction.low.z", 2, 1)


@run
def sphere(along=64, across=32, increments=10):
    radius, down, hole = 10.0, 0.05, 0.5
    # Finer towards the foot of the axis and the surface: places of the lattice with its middles.
    fine = lambda n, power: [(k / (2 * n)) ** power for k in range(2 * n + 1)]
    angles = [-90.0 + 90.0 * a for a in fine(along, 2.2)]
    radii = [radius - (radius - hole) * r for r in fine(across, 2.2)][::-1]
    place = lambda i, j: (radii[i] * math.cos(math.radians(angles[j])), radii[i] * math.sin(math.radians(angles[j])))
    ids, nodes = {}, []

    def node(i, j):
        if (i, j) not in ids:
            ids[i, j] = len(ids) + 1
            x, y = place(i, j)
            nodes.append((ids[i, j], (max(x, 0.0), y, 0.0)))
        return ids[i, j]

    ring = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    cells = [[node(i + a, j + b) for a, b in ring] for j in range(0, 2 * along, 2) for i in range(0, 2 * across, 2)]
    line = lambda cell, of: [cell[k] for k in of]
    outer = [line(cell, (1, 2, 5)) for cell in cells[across - 1::across]]
    start = [line(cell, (0, 1, 4)) for cell in cells[:across]]
    end = [line(cell, (2, 3, 6)) for cell in cells[-across:]]
    groups = [("sphere", "quad8", cells), ("outer", "line3", outer), ("axis", "line3", start), ("middle", "line3", end)]
    ours = f"""material.steel.elastic = {{ young = 210e3, poisson = 0.3 }}
body.sphere = {{ material = "steel", integration = "reduced", strain = "small" }}
tool.plane.profile = [{{ line = [[12.0, -{radius}], [0.0, -{radius}]] }}]
contact.foot = {{ surface = "outer", target = "plane", law.coulomb = {{ friction = 0.0 }} }}
[[step]]
increments.count = {increments}
displacement.axis = {{ x = 0.0 }}
displacement.middle = {{ y = -{down} }}
"""
    first, last = len(cells) + 1, len(nodes)
    tool = [(last + 1 + k + 5 * up, (3.0 * k, -radius - 1.0 * (1 - up), 0.0)) for up in (0, 1) for k in range(5)]
    # Corners and middles of two cells of eight nodes, which need those between the rows too.
    between = [(last + 11 + k, (6.0 * k, -radius - 0.5, 0.0)) for k in range(3)]
    low = lambda k: last + 1 + k
    plates = [[low(2 * e), low(2 * e + 2), low(2 * e + 7), low(2 * e + 5), low(2 * e + 1), last + 12 + e, low(2 * e + 6), last + 11 + e]
              for e in (0, 1)]
    theirs = node_rows(nodes + tool + between) + elements("CAX8R", "SPHERE", cells) + elements("CAX8R", "PLANE", plates, first)
    theirs += listed("*NSET, NSET=AXIS", sorted({n for cell in start for n in cell}))
    theirs += listed("*NSET, NSET=MIDDLE", sorted({n for cell in end for n in cell}))
    theirs += listed("*NSET, NSET=TOOL", [n for n, _ in tool + between])
    theirs += ["*SURFACE, NAME=OUTER, TYPE=ELEMENT"] + [f"{e}, S2" for e in range(across, len(cells) + 1, across)]
    theirs += ["*SURFACE, NAME=FACE, TYPE=ELEMENT"] + [f"{first + e}, S3" for e in (0, 1)]
    theirs += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "210e3, .3"]
    theirs += ["*SOLID SECTION, ELSET=SPHERE, MATERIAL=STEEL", "*SOLID SECTION, ELSET=PLANE, MATERIAL=STEEL"]
    theirs += ["*SURFACE INTERACTION, NAME=FILM", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "1e8"]
    theirs += ["*CONTACT PAIR, INTERACTION=FILM, TYPE=SURFACE TO SURFACE", "OUTER, FACE"]
    held = f"TOOL, 1, 2\nAXIS, 1, 1\nMIDDLE, 2, 2, -{down}"
    # CalculiX reports forces of an axisymmetric model for two degrees of the circumference.
    theirs = "\n".join(theirs) + steps(increments, held, "TOOL", "")
    return "axisymmetric", gmsh(nodes, groups, SHAPES), ours, theirs, ("contact.foot.force.y", 1, 180)


def run_ours(program, folder, made):
    space, mesh, deck, _, (column, _, _) = made
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "body.msh").write_text(mesh)
    (folder / "body.toml").write_text(f'version = 1\nspace = "{space}"\nmesh.file = "body.msh"\n{deck}')
    seconds, code = timed([program, "run", "body.toml", "--out", "results", "--threads", "1"], folder)
    with open(folder / "results" / "history.csv") as table:
        force = [abs(float(row[column])) for row in csv.DictReader(table)]
    summary = json.loads((folder / "results" / "summary.json").read_text())
    return seconds, force, summary["iterations"], code, summary["unknowns"]


def run_theirs(folder, made):
    *_, deck, (_, axis, parts) = made
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "body.inp").write_text(deck)
    seconds, code = timed(["ccx", "body"], folder)
    numbers = [line.split() for line in (folder / "body.dat").read_text().splitlines() if line.strip()]
    force = [parts * abs(float(row[axis])) for row in numbers if re.fullmatch(r"-?\d.*", row[0]) and len(row) == 3]
    iterations = len(re.findall(r"^ iteration \d+$", (folder / "out.txt").read_text(), re.MULTILINE))
    return seconds, force, iterations, code, 0


def tell(name, runs):
    seconds = [run[0] for run in runs]
    _, force, iterations, code, unknowns = runs[-1]
    told = ", ".join(f"{s:.2f}" for s in seconds)
    of = f", {unknowns} unknowns" if unknowns else ""
    last = f"{force[-1]:.6g}" if force else "none"
    print(f"  {name:10} {statistics.median(seconds):8.2f} s (of {told}), {iterations} iterations in {len(force)} increments, exit "
          f"{code}, last force {last}{of}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("problems", nargs="*", metavar="PROBLEM", help="cube, upsetting, sphere; all by default")
    parser.add_argument("--directory", type=pathlib.Path, default=pathlib.Path("target/side_by_side"))
    parser.add_argument("--program", default=str(pathlib.Path(__file__).resolve().parents[2] / "target/release/asperity"))
    parser.add_argument("--times", type=int, default=1)
    parser.add_argument("--only-ours", action="store_true")
    options = parser.parse_args()
    where, well = options.directory.resolve(), True
    for name in options.problems or RUNS:
        made, ours, theirs = RUNS[name](), [], []
        for _ in range(options.times):
            ours.append(run_ours(options.program, where / f"{name}_asperity", made))
            if not options.only_ours:
                theirs.append(run_theirs(where / f"{name}_calculix", made))
        print(name)
        tell("Asperity", ours)
        if theirs:
            tell("CalculiX", theirs)
            medians = [statistics.median(run[0] for run in runs) for runs in (theirs, ours)]
            print(f"  ratio of the medians {medians[0] / medians[1]:.1f}", flush=True)
        well &= all(run[3] in (0, 6) for run in ours)
    return 0 if well else 1


if __name__ == "__main__":
    sys.exit(main())
