#!/usr/bin/env python3
"""Writes coarse.msh, fine.msh and finest.msh: half of a half-cylinder shell of hex20 about the axis y, from radius 1.5 to 3
and 2.6 long, its lowest line 0.01 above z = 0."""
import math

INNER, OUTER, LENGTH, X, Z = 1.5, 3.0, 2.6, 2.5, 3.01
CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
# Middles of edges in the order of Gmsh.
EDGES = [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)]
HEX, QUAD = 17, 16


def ring(corners, edges):
    """Corners, then the middles of edges."""
    return corners + [tuple((p + q) // 2 for p, q in zip(corners[a], corners[b])) for a, b in edges]


def write(name, cells):
    """A shell of so many cells along radius, length and angle."""
    number = {}

    def place(i, j, k):
        radius = INNER + (OUTER - INNER) * i / (2 * cells[0])
        angle = math.pi * (1 + k / (2 * cells[2]))
        return X + radius * math.cos(angle), LENGTH * j / (2 * cells[1]), Z + radius * math.sin(angle)

    def nodes(base, ring):
        at = [tuple(b + r for b, r in zip(base, node)) for node in ring]
        return [number.setdefault(node, len(number) + 1) for node in at]

    quad = [(0, 1), (1, 2), (2, 3), (3, 0)]
    sides = {
        "sole": (0, ring([(0, 0, 0), (0, 2, 0), (0, 2, 2), (0, 0, 2)], quad), [cells[0]]),
        "middle": (1, ring([(0, 0, 0), (0, 0, 2), (2, 0, 2), (2, 0, 0)], quad), [0]),
        "ends": (2, ring([(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)], quad), [0, cells[2]]),
    }
    rows = []
    spans = [[2 * c for c in range(n)] for n in cells]
    for i in spans[0]:
        for j in spans[1]:
            for k in spans[2]:
                rows.append((HEX, 1, nodes((i, j, k), ring(CORNERS, EDGES))))
    for group, (axis, face, at) in enumerate(sides.values(), 2):
        for end in at:
            ranges = [[2 * end] if a == axis else spans[a] for a in range(3)]
            for i in ranges[0]:
                for j in ranges[1]:
                    for k in ranges[2]:
                        rows.append((QUAD, group, nodes((i, j, k), face)))
    with open(name, "w") as out:
        names = ['3 1 "die"'] + [f'2 {group} "{side}"' for group, side in enumerate(sides, 2)]
        out.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{len(names)}\n" + "\n".join(names))
        out.write(f"\n$EndPhysicalNames\n$Nodes\n{len(number)}\n")
        for node, n in number.items():
            out.write(f"{n} " + " ".join(f"{x:.12g}" for x in place(*node)) + "\n")
        out.write(f"$EndNodes\n$Elements\n{len(rows)}\n")
        for n, (kind, group, ids) in enumerate(rows, 1):
            out.write(f"{n} {kind} 2 {group} {group} {' '.join(map(str, ids))}\n")
        out.write("$EndElements\n")


write("coarse.msh", (2, 4, 15))
write("fine.msh", (3, 5, 21))
write("finest.msh", (4, 6, 27))
