#!/usr/bin/env python3
"""Writes slider.msh: a block 1.2 wide, its sole an arc of radius 0.75, 12 x 6 cells of second degree."""
import math

NX, NY, LEFT, SOLE, TOP, RADIUS, HALF = 12, 6, 0.2, 4.2, 1.2, 0.75, 0.6


def place(i, j):
    """Node at i of 2 NX and j of 2 NY."""
    x = HALF * (i / NX - 1.0)
    low = RADIUS - math.sqrt(RADIUS**2 - x**2)
    return LEFT + HALF + x, SOLE + low + (TOP - low) * j / (2 * NY)


def main(name):
    wanted = [(i, j) for j in range(2 * NY + 1) for i in range(2 * NX + 1) if i % 2 == 0 or j % 2 == 0]
    number = {ij: n for n, ij in enumerate(wanted, 1)}
    cells, foot, top = [], [], []
    for j in range(0, 2 * NY, 2):
        for i in range(0, 2 * NX, 2):
            ring = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
            cells.append([number[i + a, j + b] for a, b in ring])
    for i in range(0, 2 * NX, 2):
        for j, group in ((0, foot), (2 * NY, top)):
            group.append([number[i + a, j] for a in (0, 2, 1)])
    edge, quad = 8, 16
    with open(name, "w") as out:
        out.write('$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 2 "foot"\n1 3 "head"\n2 1 "slider"\n$EndPhysicalNames\n')
        out.write(f"$Nodes\n{len(wanted)}\n")
        for ij in wanted:
            x, y = place(*ij)
            out.write(f"{number[ij]} {x!r} {y!r} 0\n")
        rows = [(edge, 2, e) for e in foot] + [(edge, 3, e) for e in top] + [(quad, 1, c) for c in cells]
        out.write(f"$EndNodes\n$Elements\n{len(rows)}\n")
        for n, (kind, group, nodes) in enumerate(rows, 1):
            out.write(f"{n} {kind} 2 {group} {group} {' '.join(map(str, nodes))}\n")
        out.write("$EndElements\n")


main("slider.msh")
