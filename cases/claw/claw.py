#!/usr/bin/env python3
"""Writes claw.msh: two claws threaded through each other's mouth, in cells of second degree.

A claw is an arc of 330 degrees, mid radius 20, thickness 4, whose ends are half discs; the second is the first, turned by
180 degrees about the point between the centres. An end is meshed as a block with a ring of cells around it.

    python3 claw.py N NAME     N cells through the thickness, a multiple of 4 (claw.msh: 4)
"""
import cmath
import math
import sys

RADIUS, HALF, CENTRES = 20.0, 2.0, 34.0
CAP = HALF / RADIUS                         # angle that a half disc takes at the middle of the thickness
MOUTH = math.radians(15.0)                  # half of what is missing
GRIP = math.radians(10.0)                   # half of what is held
FACING = math.acos(0.5 * CENTRES / RADIUS)  # the mouth looks at where the other claw passes
FAR = math.pi                               # the held part looks away from the other claw


def strip(theta, radial):
    """Place of (angle, distance from the middle)."""
    return cmath.rect(RADIUS + radial, theta)


def breaks(n):
    """Angles between cells, those of the nodes in the middle included: from one end to the other, with the held part between."""
    first, last = FACING + MOUTH + CAP, FACING + 2 * math.pi - MOUTH - CAP
    angles = [first]
    for a, b in ((first, FAR - GRIP), (FAR - GRIP, FAR + GRIP), (FAR + GRIP, last)):
        cells = n * max(1, round((b - a) * RADIUS / 8.0))
        angles += [a + (b - a) * i / (2 * cells) for i in range(1, 2 * cells + 1)]
    return angles


def cap(n):
    """Patches of a half disc in (along, across): functions of a unit square, and their cells."""
    inner, quarter = 0.5 * HALF, n // 4

    def block(s, t):
        return complex(0.8 * inner * t * (1 + 0.25 * math.cos(math.pi * (s - 0.5))), inner * (2 * s - 1))

    def ring(rim, angles):
        a, b = (math.radians(angle) for angle in angles)
        return lambda s, t: (1 - t) * rim(s) + t * cmath.rect(HALF, a + (b - a) * s)

    return [
        (block, 2 * quarter, quarter),
        (ring(lambda s: block(1, s), (90, 45)), quarter, quarter),
        (ring(lambda s: block(1 - s, 1), (45, -45)), 2 * quarter, quarter),
        (ring(lambda s: block(0, 1 - s), (-45, -90)), quarter, quarter),
    ]


class Claw:
    def __init__(self, n):
        self.nodes, self.index, self.cells = [], {}, []
        angles = breaks(n)
        self.patch(lambda i, j: strip(angles[i], HALF * (1 - j / n)), len(angles) // 2, n)
        for theta, sense in ((angles[0], -1), (angles[-1], 1)):
            for place, columns, rows in cap(n):
                def at(i, j, place=place, columns=columns, rows=rows):
                    z = place(i / (2 * columns), j / (2 * rows))
                    return cmath.rect(1, theta) * complex(RADIUS + z.imag, sense * z.real)
                self.patch(at, columns, rows)
        self.grip = [k for k, z in enumerate(self.nodes) if abs(cmath.phase(-z)) < GRIP + 1e-9]

    def node(self, z):
        key = (round(z.real, 7), round(z.imag, 7))
        if key not in self.index:
            self.index[key] = len(self.nodes)
            self.nodes.append(z)
        return self.index[key]

    def patch(self, at, columns, rows):
        """Cells of a patch; `at` takes numbers of half cells."""
        for i in range(0, 2 * columns, 2):
            for j in range(0, 2 * rows, 2):
                corners = [(0, 0), (2, 0), (2, 2), (0, 2)]
                z = [at(i + a, j + b) for a, b in corners]
                if sum((z[k].conjugate() * z[(k + 1) % 4]).imag for k in range(4)) < 0:
                    corners.reverse()
                middles = [((a + c) // 2, (b + d) // 2) for (a, b), (c, d) in zip(corners, corners[1:] + corners[:1])]
                self.cells.append([self.node(at(i + a, j + b)) for a, b in corners + middles])

    def skin(self):
        """Edges that belong to one cell, the solid on their left."""
        sides = {}
        for c in self.cells:
            for k in range(4):
                edge = (c[k], c[(k + 1) % 4], c[4 + k])
                sides.setdefault(frozenset(edge[:2]), []).append(edge)
        return [edges[0] for edges in sides.values() if len(edges) == 1]


def main(n, name):
    claw = Claw(n)
    count, skin = len(claw.nodes), claw.skin()
    places = claw.nodes + [CENTRES - z for z in claw.nodes]
    rows = []
    for side in range(2):
        shift = 1 + side * count
        for kind, group, items in ((15, 5, [[k] for k in claw.grip]), (8, 3, skin), (16, 1, claw.cells)):
            rows += [(kind, group + side, [k + shift for k in item]) for item in items]
    names = [(2, "left"), (2, "right"), (1, "left_skin"), (1, "right_skin"), (0, "left_grip"), (0, "right_grip")]
    with open(name, "w") as out:
        out.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{len(names)}\n")
        for number, (dimension, group) in enumerate(names, 1):
            out.write(f'{dimension} {number} "{group}"\n')
        out.write(f"$EndPhysicalNames\n$Nodes\n{len(places)}\n")
        for number, z in enumerate(places, 1):
            out.write(f"{number} {z.real:.12g} {z.imag:.12g} 0\n")
        out.write(f"$EndNodes\n$Elements\n{len(rows)}\n")
        for number, (kind, group, nodes) in enumerate(rows, 1):
            out.write(f"{number} {kind} 2 {group} {group} {' '.join(map(str, nodes))}\n")
        out.write("$EndElements\n")


main(int(sys.argv[1]), sys.argv[2])
