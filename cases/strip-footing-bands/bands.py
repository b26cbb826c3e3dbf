"""Writes a mesh whose lines follow the slip lines of Prandtl's mechanism for the reduced angle of friction, tan phi* = sin phi:
a wedge below the footing, a fan of rays and logarithmic spirals about its edge, a wedge that is pushed out, and a rim that
fills the ground up to a circle. Half is meshed, of width 1. `python3 bands.py PHI CELLS FILE`, CELLS to the side of the wedge."""

import sys
from itertools import pairwise
from math import atan, atan2, cos, exp, hypot, pi, radians, sin, sqrt

GRADING, FAR, COARSENING = 4.0, 13.0, 5.0  # middle cell over edge cell; radius of the rim; its last cell over its first


class Mesh:
    """Nodes, merged where they coincide, and cells of three or four corners."""

    def __init__(self):
        self.numbers, self.points, self.cells = {}, [], []

    def node(self, x, y):
        """Number of the node at a place."""
        key = (round(x * 1e9), round(y * 1e9))
        if key not in self.numbers:
            self.points.append((key[0] / 1e9, key[1] / 1e9))
            self.numbers[key] = len(self.points)
        return self.numbers[key]

    def cell(self, corners):
        """Adds a cell, counter-clockwise; corners that coincide count once, and what has no area is left out."""
        nodes = list(dict.fromkeys(corners))
        if len(nodes) > 2:
            ring = [self.points[n - 1] for n in [*nodes, nodes[0]]]
            area = sum(x * v - u * y for (x, y), (u, v) in pairwise(ring))
            self.cells.append(nodes if area > 0 else nodes[::-1])

    def grid(self, at, columns, rows):
        """Cells of a grid whose node (i, j) is `at(i, j)`, or None outside."""
        for i in range(columns):
            for j in range(rows):
                nodes = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
                self.cell([n for n in nodes if n is not None])

    def write(self, path, sets):
        """Writes nodes, cells and sets of nodes in Abaqus' format."""
        with open(path, "w") as out:
            out.write("*NODE\n")
            out.writelines(f"{n}, {x!r}, {y!r}\n" for n, (x, y) in enumerate(self.points, 1))
            for kind, corners, name in ("CPE4", 4, "ground"), ("CPE3", 3, "halves"):
                out.write(f"*ELEMENT, TYPE={kind}, ELSET={name}\n")
                cells = [(n, c) for n, c in enumerate(self.cells, 1) if len(c) == corners]
                out.writelines(f"{n}, {', '.join(map(str, c))}\n" for n, c in cells)
            for name, nodes in sets.items():
                nodes = sorted(set(nodes))
                out.write(f"*NSET, NSET={name}\n")
                out.writelines(", ".join(map(str, nodes[i : i + 8])) + "\n" for i in range(0, len(nodes), 8))


def stations(length, cells):
    """Distances from the edge of the footing, graded towards both ends alike, so that the wedge's two families meet."""
    half = cells // 2
    sizes = [GRADING ** (i / (half - 1)) for i in range(half)]
    sizes += sizes[::-1]
    return [length * sum(sizes[:i]) / sum(sizes) for i in range(cells + 1)]


def ways(start, end, cells):
    """A function of (k, l): point l of `cells` on the straight line from start[k] to end[k], ever farther apart."""
    sizes = [COARSENING ** (i / (cells - 1)) for i in range(cells)]
    parts = [sum(sizes[:i]) / sum(sizes) for i in range(cells + 1)]
    return lambda k, l: tuple(a + parts[l] * (b - a) for a, b in zip(start[k], end[k]))


def rim(front):
    """Points of the circle about the edge, spaced as those of the front are."""
    lengths = [0.0]
    for (x, y), (u, v) in pairwise(front):
        lengths.append(lengths[-1] + hypot(u - x, v - y))
    first = atan2(-sqrt(FAR * FAR - 1.0), -1.0)
    angles = [first * (1.0 - length / lengths[-1]) for length in lengths]
    return [(1.0 + FAR * cos(a), FAR * sin(a)) for a in angles]


def main(friction, cells, path):
    mesh, tan = Mesh(), sin(radians(friction))
    steep = pi / 4.0 + atan(tan) / 2.0
    s, turns = stations(1.0 / cos(steep), cells), 3 * cells // 2

    def place(i, j, growth, ray, other):
        """Point i along a ray from the edge of the footing and j along the other family."""
        r, b = growth * s[i], growth * s[j]
        return 1.0 + r * cos(ray) + b * cos(other), r * sin(ray) + b * sin(other)

    def active(i, j):
        inside = j <= i and i + j <= cells
        return mesh.node(*place(i, j, 1.0, pi + steep, pi - steep)) if inside else None

    def fan(i, k):
        angle = 0.5 * pi * k / turns
        return place(i, 0, exp(tan * angle), pi + steep + angle, 0.0)

    def passive(i, j):
        return place(i, j, exp(0.5 * pi * tan), 1.5 * pi + steep, 0.5 * pi - steep)

    mesh.grid(active, cells, cells)
    mesh.grid(lambda i, k: mesh.node(*fan(i, k)), cells, turns)
    mesh.grid(lambda i, j: mesh.node(*passive(i, j)) if j <= i else None, cells, cells)
    front = [fan(cells, k) for k in range(turns)] + [passive(cells, j) for j in range(cells + 1)]
    layers = 2 + cells // 2
    outward = ways(front, rim(front), layers)
    mesh.grid(lambda k, l: mesh.node(*outward(k, l)), len(front) - 1, layers)
    numbered = list(enumerate(mesh.points, 1))
    sets = {
        "face": [n for n, (x, y) in numbered if y == 0.0 and x <= 1.0],
        "left": [n for n, (x, y) in numbered if x == 0.0],
        "rim": [mesh.node(*outward(k, layers)) for k in range(len(front))],
    }
    mesh.write(path, sets)


if __name__ == "__main__":
    main(float(sys.argv[1]), int(sys.argv[2]), sys.argv[3])
