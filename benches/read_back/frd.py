"""Compares results.frd of input decks with what CalculiX writes for them. See README.md."""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

# Of the largest value of a block.
BOUNDS = {"DISP": 1e-3, "STRESS": 1e-2, "FORC": 1e-2}
OUTPUT = "*NODE FILE\nU, RF\n*EL FILE\nS\n*END STEP"


def blocks(path):
    """Lines of nodes, lines of elements, and the last block of values of each name by node."""
    nodes, cells, values, name, part = [], [], {}, None, None
    for line in path.read_text().splitlines():
        key = line[:6]
        if key in ("    2C", "    3C"):
            part = nodes if key == "    2C" else cells
        elif line.startswith(" -4"):
            name = line[5:13].strip()
            values[name] = {}
        elif line.startswith(" -3"):
            name = part = None
        elif line.startswith((" -1", " -2")) and part is not None:
            # Groups and materials of elements are numbered by each program in its own way.
            part.append(line[:18] if part is cells and line.startswith(" -1") else line)
        elif line.startswith(" -1") and name:
            values[name][int(line[3:13])] = [float(line[i:i + 12]) for i in range(13, len(line.rstrip()), 12)]
    return nodes, cells, values


def difference(one, other):
    shared = one.keys() & other.keys()
    size = max((abs(x) for value in one.values() for x in value), default=0.0)
    worst = max((abs(x - y) for node in shared for x, y in zip(one[node], other[node])), default=float("nan"))
    return worst / size if size > 0 else worst


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("decks", type=Path, nargs="+")
    parser.add_argument("--asperity", default="asperity", help="the command")
    parser.add_argument("--ccx", default="ccx", help="the command")
    arguments = parser.parse_args()
    good = True
    for deck in arguments.decks:
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            text = deck.read_text()
            (folder / "model.inp").write_text(text.replace("*END STEP", OUTPUT).replace("*End Step", OUTPUT))
            for command in ([arguments.ccx, "model"], [arguments.asperity, "run", "model.inp", "--no-report"]):
                subprocess.run(command, cwd=folder, capture_output=True, check=False)
            files = [folder / "model.frd", folder / "model.results/results.frd"]
            lost = [file.name for file in files if not file.exists()]
            if lost:
                print(f"{deck.name:32s} no {', '.join(lost)}")
                good = False
                continue
            (nodes, cells, theirs), (our_nodes, our_cells, ours) = map(blocks, files)
            figures = {name: difference(theirs[name], ours[name]) for name in BOUNDS if name in theirs and name in ours}
            kept = all(error <= BOUNDS[name] for name, error in figures.items()) and nodes == our_nodes and cells == our_cells
            good &= kept
            said = ", ".join(f"{name} {error:.1e}" for name, error in figures.items())
            same = f"nodes {'same' if nodes == our_nodes else 'DIFFER'}, elements {'same' if cells == our_cells else 'DIFFER'}"
            print(f"{deck.name:32s} {same}, {said}  {'ok' if kept else 'FAILED'}")
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
