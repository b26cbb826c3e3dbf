#!/usr/bin/env python3
"""Writes coarse.msh and fine.msh: two half blocks of hex20, y >= 0, whose facing sides are paraboloids of radius 8 about the
axis z, and flat cones beyond r = 1.5. Cells are small where they touch."""
import math

RADIUS, ROUND, HALF, DEPTH, TIP = 8.0, 1.5, 4.0, 4.0, 0.72
CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
# Middles of edges in the order of Gmsh.
EDGES = [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)]
HEX, QUAD = 17, 16
# Sides in the lattice: facing away from the other block, towards it, the plane y = 0.
BASE = [(0, 0, 0), (0, 2, 0), (2, 2, 0), (2, 0, 0)]
FACE = [(0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
MIDDLE = [(0, 0, 0), (2, 0, 0), (2, 0, 2), (0, 0, 2)]


def ring(corners, edges):
    """Corners, then the middles of edges."""
    return corners + [tuple((p + q) // 2 for p, q in zip(corners[a], corners[b])) for a, b in edges]


def run(start, end, count, ratio):
    """Stations and their middles; the last cell is `ratio` times the first."""
    growth = ratio ** (1 / max(count - 1, 1))
    sizes = [growth**k for k in range(count)]
    stations = [start]
    for size in sizes:
        step = (end - start) * size / sum(sizes)
        stations += [stations[-1] + 0.5 * step, stations[-1] + step]
    return stations


def gap(x, y):
    r = math.hypot(x, y)
    inner = min(r, ROUND)
    return inner**2 / (2 * RADIUS) + ROUND / RADIUS * (r - inner)


def lens(side, fine, coarse, layers, number, points):
    """Cells and sides of the block above (1) or below (-1), `fine` cells across the tip."""
    outer = run(TIP, HALF, coarse, 4.0)[1:]
    x = [-s for s in reversed(outer)] + run(-TIP, TIP, fine, 1.0) + outer
    y = run(0.0, TIP, fine // 2, 1.0) + outer
    z = run(DEPTH, 0.0, layers, 0.06)

    def place(i, j, k):
        bump = gap(x[i], y[j]) * (1 - z[k] / DEPTH)
        # The block below is the one above, turned about the axis x and mirrored in y.
        return x[i], y[j], side * (bump + z[k])

    def nodes(base, ids):
        if side > 0:
            # Upside down, so that the corners' turn is kept.
            ids = [ids[k] for k in FLIP[len(ids)]]
        at = [tuple(b + r for b, r in zip(base, node)) for node in ids]
        for node in at:
            key = (side,) + node
            if key not in number:
                number[key] = len(number) + 1
                points.append(place(*node))
        return [number[(side,) + node] for node in at]

    spans = [range(0, len(s) - 1, 2) for s in (x, y, z)]
    top, tip = len(z) - 3, (2 * coarse, 2 * (coarse + fine), fine)
    cells = [nodes((i, j, k), ring(CORNERS, EDGES)) for i in spans[0] for j in spans[1] for k in spans[2]]
    quad = [(0, 1), (1, 2), (2, 3), (3, 0)]
    base = [nodes((i, j, 0), ring(BASE, quad)) for i in spans[0] for j in spans[1]]
    middle = [nodes((i, 0, k), ring(MIDDLE, quad)) for i in spans[0] for k in spans[2]]
    within = [(i, j) for i in spans[0] for j in spans[1] if tip[0] <= i < tip[1] and j < tip[2]]
    return cells, base, middle, [nodes((i, j, top), ring(FACE, quad)) for i, j in within]


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


write("coarse.msh", (8, 2, 4), (10, 2, 4))
write("fine.msh", (12, 2, 5), (14, 2, 5))
