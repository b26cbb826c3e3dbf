#!/usr/bin/env python3
"""Two equal spheres pressed together, beside Hertz: CalculiX 2.20 (Debian `calculix-ccx`) and Asperity.

    cargo build --release
    python3 benches/side_by_side/spheres.py [--directory DIR] [--refine 2]

The spheres of `cases/hertz-spheres`, axisymmetric, cells of eight nodes with reduced integration on like meshes, no friction,
the diametral planes moved together by 3.7: about the force for which Hertz' radius is 10. CalculiX takes face-to-face contact,
linear geometry and its laws of large strain; ours small strain, its rate law and neo-Hookean. Radius and largest pressure are
those of the line through r^2 and p^2 by least squares, over those of Hertz for the force found. At CalculiX p is the stress along
the axis at the nodes of the surface, which is per undeformed area if geometry is linear; ours in small strain is the force over the
area that the undeformed surface has on the plane of contact. Radii are undeformed in both. Nodes within a fifth of the radius
from the axis are left out for both, as its elements at the axis are wedges that disturb it. Needs numpy and meshio.
"""
import argparse
import csv
import math
import pathlib
import re
import sys

import meshio
import numpy as np

from side_by_side import timed

RADIUS, HOLE, YOUNG, NU, DEPTH, INCREMENTS, PENALTY = 50.0, 5.0, 20e3, 0.3, 3.7, 10, 1e6
SHEAR, BULK = YOUNG / (2 * (1 + NU)), YOUNG / (3 * (1 - 2 * NU))
THEIRS = {
    "linear geometry": (f"*ELASTIC\n{YOUNG}, {NU}", ""),
    "linear in Green's strain": (f"*ELASTIC\n{YOUNG}, {NU}", ", NLGEOM"),
    "neo-Hookean": (f"*HYPERELASTIC, NEO HOOKE\n{SHEAR / 2}, {2 / BULK}", ", NLGEOM"),
}
ELASTIC = f"elastic]\nyoung = {YOUNG}\npoisson = {NU}"
OURS = {
    "small strain": (ELASTIC, "small"),
    "rate law": (ELASTIC, "finite"),
    "neo-Hookean": (f"neo_hookean]\nshear = {SHEAR}\nbulk = {BULK}", "finite"),
}


def lattice(ends, cells, ratio):
    """Places of corners and middles of cells along a line, the last `ratio` as long as the first."""
    lengths = ratio ** (np.arange(cells) / (cells - 1))
    corners = ends[0] + (ends[1] - ends[0]) * np.append(0.0, np.cumsum(lengths)) / lengths.sum()
    return np.interp(np.arange(2 * cells + 1) / 2, np.arange(cells + 1), corners)


def quarter(refine, up, first):
    """Nodes by their places in the lattice of radius and angle, and elements with the side on the surface, if it has one."""
    radii = np.append(lattice((HOLE, 47.5), 10 * refine, 0.1), lattice((47.5, RADIUS), 4 * refine, 1.0)[1:])
    angles = np.append(lattice((0.0, 74.0), 12 * refine, 0.15), lattice((74.0, 90.0), 20 * refine, 1.0)[1:])
    nodes, elements = {}, []
    ring = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    # The mirror image runs the other way round.
    ring = [ring[k] for k in (0, 3, 2, 1, 7, 6, 5, 4)] if up else ring
    for i in range(0, len(radii) - 1, 2):
        for j in range(0, len(angles) - 1, 2):
            side = (3 if up else 2) if i == len(radii) - 3 and angles[j] > 60 else None
            ids = [nodes.setdefault((i + a, j + b), first + len(nodes)) for a, b in ring]
            elements.append((ids, side))
    turn = np.radians(angles)
    place = lambda i, j: (radii[i] * abs(math.cos(turn[j])), (-1 if up else 1) * (radii[i] * math.sin(turn[j]) - RADIUS))
    ends = [[n for (_, j), n in nodes.items() if j == end] for end in (0, len(angles) - 1)]
    return [(n, *place(*at)) for at, n in nodes.items()], elements, ends


def write_theirs(folder, refine, law, geometry):
    lower = quarter(refine, False, 1)
    spheres = [("LOW", lower), ("UP", quarter(refine, True, 1 + len(lower[0])))]
    lines = ["*NODE, NSET=NALL"] + [f"{n}, {x:.12f}, {y:.12f}, 0." for _, sphere in spheres for n, x, y in sphere[0]]
    number = 0
    for name, (_, elements, ends) in spheres:
        lines += ["*ELEMENT, TYPE=CAX8R, ELSET=BOTH"]
        lines += [f"{number + e}, {', '.join(map(str, ids))}" for e, (ids, _) in enumerate(elements, 1)]
        lines += [f"*SURFACE, NAME={name}, TYPE=ELEMENT"]
        lines += [f"{number + e}, S{side}" for e, (_, side) in enumerate(elements, 1) if side]
        for end, ids in zip(("PLANE", "AXIS"), ends):
            lines += [f"*NSET, NSET={name}{end}"] + [f"{n}," for n in ids]
        number += len(elements)
    (folder / "spheres.inp").write_text("\n".join(lines) + f"""
*MATERIAL, NAME=SOFT
{law}
*SOLID SECTION, ELSET=BOTH, MATERIAL=SOFT
*SURFACE INTERACTION, NAME=FILM
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
{PENALTY}
*CONTACT PAIR, INTERACTION=FILM, TYPE=SURFACE TO SURFACE
LOW, UP
*STEP{geometry}, INC=1000
*STATIC, DIRECT
{1 / INCREMENTS}, 1.
*BOUNDARY
LOWPLANE, 2, 2
LOWAXIS, 1, 1
UPAXIS, 1, 1
UPPLANE, 2, 2, {-DEPTH}
*NODE PRINT, NSET=LOWPLANE, TOTALS=ONLY
RF
*NODE FILE, OUTPUT=3D, FREQUENCY={INCREMENTS}
U
*EL FILE
S
*END STEP
""")


def blocks(path):
    """Coordinates, displacements and stresses at the nodes, by the names of the blocks of a result file."""
    found, now = {}, None
    for line in path.read_text().splitlines():
        if line.startswith("    2C"):
            now = found.setdefault("NODES", {})
        elif line.startswith(" -4"):
            now = found.setdefault(line[5:13].strip(), {})
        elif line.startswith(" -3"):
            now = None
        elif line.startswith(" -1") and now is not None:
            now[int(line[3:13])] = [float(line[k:k + 12]) for k in range(13, len(line.rstrip()), 12)]
    return found


def run_theirs(folder, refine, law, geometry):
    folder.mkdir(parents=True, exist_ok=True)
    write_theirs(folder, refine, law, geometry)
    timed(["ccx", "spheres"], folder)
    totals = [row.split() for row in (folder / "spheres.dat").read_text().splitlines() if re.match(r"\s+-?\d", row)]
    found = blocks(folder / "spheres.frd")
    # The elements become a sector of two degrees; the lower sphere is about (0, -RADIUS, 0).
    outer = [n for n, x in found["NODES"].items() if x[1] <= 0 and abs(math.dist(x, (0, -RADIUS, 0)) - RADIUS) < 1e-6]
    at = np.array([np.add(found["NODES"][n], found["DISP"][n]) if geometry else found["NODES"][n] for n in outer])
    pressure = np.array([-found["STRESS"][n][1] for n in outer])
    return 180 * float(totals[-1][1]), np.hypot(at[:, 0], at[:, 2]), pressure


def run_ours(program, folder, refine, law, strain):
    folder.mkdir(parents=True, exist_ok=True)
    part = lambda name, centre, start, angles: f"""[mesh.part.{name}.annulus]
centre = [0.0, {centre}]
from = [{HOLE}, {start}]
along_radius = [{{ to = 47.5, cells = {10 * refine}, ratio = 0.1 }}, {{ to = {RADIUS}, cells = {4 * refine} }}]
along_angle = [{angles}]
cell = "quad8"
"""
    near, far = 20 * refine, 12 * refine
    (folder / "spheres.toml").write_text(
        'version = 1\ntitle = "Two elastic spheres"\nspace = "axisymmetric"\n'
        + part("lower", -RADIUS, 0.0, f"{{ to = 74.0, cells = {far}, ratio = 0.15 }}, {{ to = 90.0, cells = {near} }}")
        + part("upper", RADIUS, -90.0, f"{{ to = -74.0, cells = {near} }}, {{ to = 0.0, cells = {far}, ratio = 6.7 }}")
        + f"[material.soft.{law}\n" + "".join(f'[body.{name}]\nmaterial = "soft"\nintegration = "reduced"\n'
                                               f'strain = "{strain}"\n' for name in ("lower", "upper"))
        + f"""[contact.touch]
surface = "lower.outer"
target = "upper.outer"
law.coulomb = {{ friction = 0.0 }}
gauss = 3
penalty = {PENALTY}
[[step]]
symmetry = ["lower.start", "lower.end", "upper.start"]
displacement."upper.end" = {{ y = {-DEPTH} }}
increments.count = {INCREMENTS}
""")
    timed([program, "run", "spheres.toml", "--out", "results", "--threads", "1"], folder)
    with open(folder / "results" / "history.csv") as table:
        force = float(list(csv.DictReader(table))[-1]["reaction.lower.start.y"])
    frames = (folder / "results" / "contacts").glob("*.vtu")
    first, *_, last = map(meshio.read, sorted(frames))
    lower = last.point_data["contact"] == 0
    if strain == "small":
        area = first.point_data["contact_area"] * first.point_data["contact_normal"][:, 1]
        return force, last.points[lower, 0], np.abs(last.point_data["contact_force"][:, 1] / area)[lower]
    return force, (last.points + last.point_data["displacement"])[lower, 0], last.point_data["contact_pressure"][lower]


def tell(name, force, r, p):
    radius = (0.75 * force * RADIUS / 2 * 2 * (1 - NU**2) / YOUNG) ** (1 / 3)
    p, r = p[r > 0.2 * radius], r[r > 0.2 * radius]
    largest = p.max()
    for _ in range(3):
        near = p > 0.2 * largest
        slope, square = np.polyfit(r[near] ** 2, p[near] ** 2, 1)
        width, largest = math.sqrt(-square / slope), math.sqrt(square)
    told = [100 * (width / radius - 1), 100 * (largest * math.pi * radius**2 / (1.5 * force) - 1)]
    print(f"{name:35} force {force / 1e3:7.1f} kN, beside Hertz: a {told[0]:+6.2f} %, p0 {told[1]:+6.2f} %", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--directory", type=pathlib.Path, default=pathlib.Path("target/side_by_side"))
    parser.add_argument("--refine", type=int, default=2)
    options = parser.parse_args()
    root = pathlib.Path(__file__).resolve().parents[2]
    program, where = str(root / "target/release/asperity"), options.directory.resolve()
    for name, (law, strain) in OURS.items():
        tell(f"Asperity, {name}", *run_ours(program, where / "spheres_asperity", options.refine, law, strain))
    for name, (law, geometry) in THEIRS.items():
        tell(f"CalculiX, {name}", *run_theirs(where / "spheres_calculix", options.refine, law, geometry))
    return 0


if __name__ == "__main__":
    sys.exit(main())
