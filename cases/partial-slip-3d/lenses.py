#!/usr/bin/env python3
"""Writes coarse.msh and fine.msh: two half cylinders of hex20, y >= 0, whose facing sides are paraboloids of radius 32 about
the axis z, and flat cones beyond r = 1.5. Cells lie in rings, narrow where the contact slips, about a square core."""
import math

RADIUS, ROUND, HALF, DEPTH = 32.0, 1.5, 4.0, 4.0
CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
# Middles of edges in the order of Gmsh.
EDGES = [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)]
HEX, QUAD = 17, 16
# Sides in the lattice: facing away from the other block, towards it, the plane y = 0 at both ends of a half turn.
BASE = [(0, 0, 0), (0, 2, 0), (2, 2, 0), (2, 0, 0)]
FACE = [(0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
MIDDLE = [(0, 0, 0), (2, 0, 0), (2, 0, 2), (0, 0, 2)]
OTHER = [(0, 2, 0), (0, 2, 2), (2, 2, 2), (2, 2, 0)]
# The core's half width, and how round its outline is.
CORE, ROUNDED = 0.2, 0.5
TIP = 0.75


def ring(corners, edges):
    """Corners, then the middles of edges."""
    return corners + [tuple((p + q) // 2 for p, q in zip(corners[a], corners[b])) for a, b in edges]


def doubled(ends):
    """Stations and their middles."""
    return [ends[0]] + [x for a, b in zip(ends, ends[1:]) for x in (0.5 * (a + b), b)]


def run(start, end, count, ratio):
    """Ends of cells, the last of which is `ratio` times the first."""
    growth = ratio ** (1 / max(count - 1, 1))
    sizes = [growth**k for k in range(count)]
    return [start + (end - start) * sum(sizes[:k]) / sum(sizes) for k in range(count + 1)]


def gap(x, y):
    r = math.hypot(x, y)
    inner = min(r, ROUND)
    return inner**2 / (2 * RADIUS) + ROUND / RADIUS * (r - inner)


def core(u, v):
    """The place of (u, v) in the core, from -1 to 1 and from 0 to 1: a square that gets round outwards."""
    m = max(abs(u), v)
    if m == 0.0:
        return 0.0, 0.0
    if v >= abs(u):
        angle = math.pi / 2 - math.pi / 4 * u / v
    else:
        angle = math.pi / 4 * v / u if u > 0 else math.pi + math.pi / 4 * v / u
    w = ROUNDED * m
    return tuple(CORE * ((1 - w) * s + w * m * c) for s, c in ((u, math.cos(angle)), (v, math.sin(angle))))


def outline(angle):
    """The core's outline."""
    part = 4 * angle / math.pi
    if part <= 1:
        return core(1.0, part)
    return core(2.0 - part, 1.0) if part <= 3 else core(-1.0, 4.0 - part)


def patches(across, radii):
    """Pieces of the plane: number of cells both ways, the place of a node, and which cells are the tip's."""
    yield across, across // 2, lambda i, j: core(i / across - 1.0, j / across), lambda i: True
    stations, first = doubled([CORE] + radii), radii[0]

    def around(i, j):
        angle, r = math.pi * j / (4 * across), stations[i]
        x, y = outline(angle)
        # Round from the first ring's outer side on.
        w = min(1.0, (r - CORE) / (first - CORE))
        end = max(r, first)
        return (1 - w) * x + w * end * math.cos(angle), (1 - w) * y + w * end * math.sin(angle)

    yield len(radii), 2 * across, around, lambda i: stations[i + 2] <= TIP + 1e-9


def lens(side, across, radii, layers, number, points):
    """Cells and sides of the block above (1) or below (-1)."""
    z = doubled(run(DEPTH, 0.0, *layers))
    top = len(z) - 3
    cells, base, middle, face = [], [], [], []
    for m, n, place, at_tip in patches(across, radii):

        def nodes(origin, ids):
            if side > 0:
                # Upside down, so that the corners' turn is kept.
                ids = [ids[k] for k in FLIP[len(ids)]]
            found = []
            for di, dj, dk in ids:
                x, y = place(origin[0] + di, origin[1] + dj)
                y = 0.0 if abs(y) < 1e-12 else y
                k = origin[2] + dk
                key = (side, round(x, 9) + 0.0, round(y, 9) + 0.0, k)
                if key not in number:
                    number[key] = len(number) + 1
                    points.append((x, y, side * (gap(x, y) * (1 - z[k] / DEPTH) + z[k])))
                found.append(number[key])
            return found

        quad = [(0, 1), (1, 2), (2, 3), (3, 0)]
        for i in range(0, 2 * m, 2):
            for j in range(0, 2 * n, 2):
                cells += [nodes((i, j, k), ring(CORNERS, EDGES)) for k in range(0, top + 1, 2)]
                base.append(nodes((i, j, 0), ring(BASE, quad)))
                if at_tip(i):
                    face.append(nodes((i, j, top), ring(FACE, quad)))
                sides = ((MIDDLE, j == 0), (OTHER, j + 2 == 2 * n and n == 2 * across))
                for shape, there in sides:
                    if there:
                        middle += [nodes((i, j, k), ring(shape, quad)) for k in range(0, top + 1, 2)]
    return cells, base, middle, face


def flipped(corners, order, edges):
    """Places of the nodes of a mirrored cell: its corners in another order, and the edges between them."""
    middles = {frozenset(e): len(corners) + k for k, e in enumerate(edges)}
    return order + [middles[frozenset((order[a], order[b]))] for a, b in edges]


FLIP = {
    20: flipped(CORNERS, [4, 5, 6, 7, 0, 1, 2, 3], EDGES),
    8: flipped(FACE, [0, 3, 2, 1], [(0, 1), (1, 2), (2, 3), (3, 0)]),
}


def write(name, upper, lower):
    number, points, rows, names = {}, [], [], []
    for block, side, size in (("upper", 1, upper), ("lower", -1, lower)):
        parts = zip(("", ".base", ".middle", ".tip"), lens(side, *size, number, points))
        for suffix, cells in parts:
            kind = QUAD if suffix else HEX
            names.append(f'{2 if suffix else 3} {len(names) + 1} "{block}{suffix}"')
            rows += [(kind, len(names), nodes) for nodes in cells]
    with open(name, "w") as out:
        out.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{len(names)}\n" + "\n".join(names))
        out.write(f"\n$EndPhysicalNames\n$Nodes\n{len(points)}\n")
        for n, x in enumerate(points, 1):
            out.write(f"{n} " + " ".join(f"{c:.10g}" for c in x) + "\n")
        out.write(f"$EndNodes\n$Elements\n{len(rows)}\n")
        for n, (kind, group, nodes) in enumerate(rows, 1):
            out.write(f"{n} {kind} 2 {group} {group} {' '.join(map(str, nodes))}\n")
        out.write("$EndElements\n")


def radii(fine, outer):
    """Rings: one to 0.3, so many to the tip, and so many beyond it."""
    return [0.3] + run(0.3, TIP, fine, 1.0)[1:] + run(TIP, HALF, outer, 5.0)[1:]


write("coarse.msh", (4, radii(6, 2), (5, 0.03)), (4, radii(7, 2), (5, 0.03)))
write("fine.msh", (4, radii(8, 3), (6, 0.02)), (6, radii(9, 3), (6, 0.02)))
