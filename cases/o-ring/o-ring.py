"""Writes o-ring.msh: a disc of radius 2 about (20, 2) of cells quad8, a square core of N by N in a ring of M layers."""

from math import cos, pi, sin

N, M, R, CORE, CENTRE = 8, 4, 2.0, 1.0, (20.0, 2.0)


def on_square(k):
    """Point k of the 8 N points, midpoints among them, around the core, counter-clockwise from its lower left corner."""
    side, along = divmod(k, 2 * N)
    t = -1 + along / N
    half = CORE / 2**0.5
    bulge = 1 + 0.12 * (1 - t * t)
    x, y = [(t, -bulge), (bulge, t), (-t, bulge), (-bulge, -t)][side]
    return half * x, half * y


def on_circle(k):
    angle = -0.75 * pi + 2 * pi * k / (8 * N)
    return R * cos(angle), R * sin(angle)


def core(i, j):
    """Point (i, j) of the core, of 2 N + 1 by 2 N + 1: Coons' patch of its four curved sides."""
    s, t = i / (2 * N), j / (2 * N)
    low, right = on_square(i), on_square(2 * N + j)
    high, left = on_square(6 * N - i), on_square((8 * N - j) % (8 * N))
    corners = [on_square(2 * N * k) for k in range(4)]
    weights = [(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t]
    blend = [sum(w * c[a] for w, c in zip(weights, corners)) for a in range(2)]
    return tuple((1 - t) * low[a] + t * high[a] + (1 - s) * left[a] + s * right[a] - blend[a] for a in range(2))


def ring(k, m):
    """Point of the ring: place k around it, half layer m from the core to the circle."""
    (a, b), (c, d), t = on_square(k), on_circle(k), m / (2 * M)
    return (1 - t) * a + t * c, (1 - t) * b + t * d


nodes, numbers = [], {}


def number(point):
    key = tuple(round(x, 9) for x in point)
    if key not in numbers:
        numbers[key] = len(nodes) + 1
        nodes.append((point[0] + CENTRE[0], point[1] + CENTRE[1]))
    return numbers[key]


def quad8(at):
    places = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    return [number(at(a, b)) for a, b in places]


cells = [quad8(lambda a, b: core(2 * i + a, 2 * j + b)) for j in range(N) for i in range(N)]
wrap = 8 * N
cells += [quad8(lambda a, b: ring((2 * i + b) % wrap, 2 * m + a)) for i in range(4 * N) for m in range(M)]
# The area must be positive: from the core outward, then counter-clockwise.
skin = [[number(ring(k % wrap, 2 * M)) for k in (2 * i, 2 * i + 2, 2 * i + 1)] for i in range(4 * N)]

lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '1 1 "skin"', '2 2 "ring"', "$EndPhysicalNames"]
lines += ["$Nodes", str(len(nodes))] + [f"{i + 1} {x:.12g} {y:.12g} 0" for i, (x, y) in enumerate(nodes)] + ["$EndNodes"]
elements = [(8, 1, s) for s in skin] + [(16, 2, c) for c in cells]
lines += ["$Elements", str(len(elements))]
lines += [f"{i + 1} {kind} 2 {tag} {tag} " + " ".join(map(str, n)) for i, (kind, tag, n) in enumerate(elements)]
lines += ["$EndElements"]
with open("o-ring.msh", "w") as file:
    file.write("\n".join(lines) + "\n")
