"""Writes wedge.inp: the slice of soil of pile.toml as a wedge of two degrees about the axis z, one cell wide and high."""

from math import cos, radians, sin

RADII, HEIGHT, ANGLE, CELLS, RATIO = (500.0, 5000.0), 20.0, 2.0, 24, 20.0


def stations():
    """Radii of corners and middles, the last cell RATIO times as long as the first."""
    growth = RATIO ** (1.0 / (CELLS - 1))
    lengths = [growth**i for i in range(CELLS)]
    part = (RADII[1] - RADII[0]) / sum(lengths)
    radii = [RADII[0]]
    for length in lengths:
        radii += [radii[-1] + 0.5 * part * length, radii[-1] + part * length]
    return radii


def main():
    numbers, lines = {}, []
    radii = stations()

    def node(i, j, k):
        """Number of the node at half-cells (i, j, k) along radius, angle and height."""
        if (i, j, k) not in numbers:
            numbers[i, j, k] = len(numbers) + 1
            angle = radians(0.5 * ANGLE * (j - 1))
            x, y, z = radii[i] * cos(angle), radii[i] * sin(angle), 0.5 * HEIGHT * k
            lines.append(f"{numbers[i, j, k]}, {x!r}, {y!r}, {z!r}")
        return numbers[i, j, k]

    corners = [(0, 0), (2, 0), (2, 2), (0, 2)]
    middles = [(1, 0), (2, 1), (1, 2), (0, 1)]
    cells = []
    for c in range(CELLS):
        at = lambda ring, k: [node(2 * c + i, j, k) for i, j in ring]
        nodes = at(corners, 0) + at(corners, 2) + at(middles, 0) + at(middles, 2) + at(corners, 1)
        cells.append(f"{c + 1}, " + ", ".join(map(str, nodes[:15])) + ",\n " + ", ".join(map(str, nodes[15:])))
    sides = {"bottom": "S1", "top": "S2", "start": "S3", "end": "S5"}
    with open("wedge.inp", "w") as out:
        out.write("*NODE\n" + "\n".join(lines) + "\n*ELEMENT, TYPE=C3D20, ELSET=soil\n" + "\n".join(cells) + "\n")
        for name, side in sides.items():
            out.write(f"*SURFACE, NAME={name}, TYPE=ELEMENT\nsoil, {side}\n")
        out.write(f"*SURFACE, NAME=inner, TYPE=ELEMENT\n1, S6\n*SURFACE, NAME=outer, TYPE=ELEMENT\n{CELLS}, S4\n")


if __name__ == "__main__":
    main()
