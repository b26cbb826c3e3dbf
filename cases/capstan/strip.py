#!/usr/bin/env python3
"""Writes strip.msh: a quarter of a belt 1 thick and 2 wide on a drum of radius 50, 2 x 45 x 1 cells hex20."""
import math

RADIAL, AROUND, RADIUS, THICK, WIDE = 2, 45, 50.0, 1.0, 2.0
CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
EDGES = [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)]
# Sides as corners that turn about the outward normal.
SIDES = {"inner": (0, 4, 7, 3), "start": (0, 1, 5, 4), "end": (3, 7, 6, 2), "back": (0, 3, 2, 1), "front": (4, 5, 6, 7)}
INDEX, PLACES = {}, []


def node(i, j, k):
    if (i, j, k) not in INDEX:
        radius, angle = RADIUS + THICK * i / (2 * RADIAL), 0.5 * math.pi * j / (2 * AROUND)
        INDEX[i, j, k] = len(PLACES) + 1
        PLACES.append((radius * math.cos(angle), radius * math.sin(angle), WIDE * k / 2))
    return INDEX[i, j, k]


def middle(a, b):
    return tuple((x + y) // 2 for x, y in zip(a, b))


def main(name):
    rows, groups = [], ["belt", *SIDES]
    for i in range(0, 2 * RADIAL, 2):
        for j in range(0, 2 * AROUND, 2):
            at = [(i + a, j + b, c) for a, b, c in CORNERS]
            rows.append((17, 1, [node(*p) for p in at] + [node(*middle(at[a], at[b])) for a, b in EDGES]))
            outer = {"inner": i == 0, "start": j == 0, "end": j == 2 * AROUND - 2, "back": True, "front": True}
            for side in (side for side in SIDES if outer[side]):
                ring = [at[c] for c in SIDES[side]]
                middles = [middle(a, b) for a, b in zip(ring, ring[1:] + ring[:1])]
                rows.append((16, 1 + groups.index(side), [node(*p) for p in ring + middles]))
    with open(name, "w") as out:
        out.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{len(groups)}\n")
        for number, group in enumerate(groups, 1):
            out.write(f'{3 if number == 1 else 2} {number} "{group}"\n')
        out.write(f"$EndPhysicalNames\n$Nodes\n{len(PLACES)}\n")
        for number, place in enumerate(PLACES, 1):
            out.write(f"{number} {' '.join(f'{x:.12g}' for x in place)}\n")
        out.write(f"$EndNodes\n$Elements\n{len(rows)}\n")
        for number, (kind, group, nodes) in enumerate(rows, 1):
            out.write(f"{number} {kind} 2 {group} {group} {' '.join(map(str, nodes))}\n")
        out.write("$EndElements\n")


main("strip.msh")
