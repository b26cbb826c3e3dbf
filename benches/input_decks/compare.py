"""Runs input decks in CalculiX and here and compares the displacements at the end. See README.md."""

import argparse
import gzip
import os
import re
import subprocess
import sys
from pathlib import Path

import meshio
import numpy as np
from meshio._mesh import topological_dimension

# meshio 5.3 reads these cells and does not know their dimension.
topological_dimension.setdefault("wedge15", 3)


OTHER_PROCEDURES = r"(?im)^\*(dynamic|modal|frequency|buckle|heat|coupled|uncoupled|steady|visco|green|complex|substructure|electro|cfd|sensitivity|no analysis)"


def calculix(text, name, folder, seconds):
    """Displacements by node of the last table of the .dat file; None if it failed."""
    (folder / f"{name}.inp").write_text(text)
    environment = dict(os.environ, OMP_NUM_THREADS="1")
    try:
        run = subprocess.run(["ccx", name], cwd=folder, capture_output=True, text=True, env=environment, timeout=seconds)
    except subprocess.TimeoutExpired:
        return None
    (folder / "ccx.log").write_text(run.stdout + run.stderr)
    if not (folder / f"{name}.dat").exists():
        return None
    tables = re.split(r"displacements \(vx,vy,vz\)[^\n]*\n", (folder / f"{name}.dat").read_text())
    if "*ERROR" in run.stdout or len(tables) < 2:
        return None
    # The table ends where the next one begins.
    table = re.split(r"\n\s*[a-zA-Z]", tables[-1])[0]
    rows = [line.split() for line in table.splitlines() if line.strip()]
    return {int(row[0]): np.array(row[1:4], dtype=float) for row in rows if len(row) == 4 and row[0].isdigit()}


def translated(deck, folder, program):
    """Whether the deck can be translated."""
    run = subprocess.run([program, "translate", deck.resolve()], cwd=folder, capture_output=True, text=True)
    (folder / "translate.log").write_text(run.stdout + run.stderr)
    return run.returncode == 0


def ours(deck, folder, program, seconds):
    """Displacements by node at the end of our run; None if it failed."""
    command = [program, "run", f"{deck.stem}.toml", "--out", "ours", "--no-report"]
    try:
        run = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        return None
    (folder / "asperity.log").write_text(run.stdout + run.stderr)
    if run.returncode not in (0, 6):
        return None
    last = re.findall(r'file="([^"]+)"', (folder / "ours" / "bodies.pvd").read_text())[-1]
    grid = meshio.read(folder / "ours" / last)
    nodes = [int(line.split(",")[0]) for line in mesh_nodes(folder / f"{deck.stem}.mesh.inp")]
    found = grid.point_data["displacement"]
    return dict(zip(nodes, found))


def mesh_nodes(path):
    """The lines of nodes of a translated mesh."""
    lines = path.read_text().split("*NODE\n")[1].split("*ELEMENT")[0]
    return lines.strip().splitlines()


def printing(text, nodes):
    """A deck that prints the displacements of these nodes at the end of each step."""
    rows = "\n".join(str(node) for node in nodes)
    text = re.sub(r"(?im)^\*step", f"*NSET, NSET=NOFALL\n{rows}\n*STEP", text, count=1)
    return re.sub(r"(?im)^\*end *step", "*NODE PRINT, NSET=NOFALL, FREQUENCY=1, GLOBAL=YES\nU\n*END STEP", text)


SYMMETRIES = {"XSYMM": "1", "YSYMM": "2", "ZSYMM": "3", "PINNED": "1, 3", "ENCASTRE": "1, 3"}


def spelled(text):
    """A deck in words that CalculiX knows too: supports by number, nodes of elements and equations between sets written out."""
    out, elements, sets, keyword, lines = [], {}, {}, "", iter(text.splitlines())
    for line in lines:
        if line.startswith("*") and not line.startswith("**"):
            keyword = re.sub(r"\s+", "", line).upper()
            elset, nset = (re.search(rf"[,]{name}=([^,]+)", keyword) for name in ("ELSET", "NSET"))
            if keyword.startswith("*NSET,") and elset:
                nodes = sorted({node for nodes in elements[elset[1]] for node in nodes})
                sets[nset[1]] = nodes
                out += [f"*NSET, NSET={nset[1]}", *map(str, nodes)]
                continue
            if keyword.startswith("*CONTACTPAIR") and "TYPE=" not in keyword:
                line += ", TYPE=SURFACE TO SURFACE"
        elif not line.startswith("**"):
            fields = [field.strip() for field in line.rstrip(",").split(",")]
            if keyword.startswith("*ELEMENT,") and elset:
                elements.setdefault(elset[1], []).append([int(field) for field in fields[1:]])
            elif keyword.startswith("*NSET,") and nset and "GENERATE" not in keyword and all(map(str.isdigit, fields)):
                sets.setdefault(nset[1], []).extend(map(int, fields))
            elif keyword.startswith("*BOUNDARY") and fields[1].upper() in SYMMETRIES:
                line = f"{fields[0]}, {SYMMETRIES[fields[1].upper()]}"
            elif keyword.startswith("*EQUATION") and fields[0].upper() in sets:
                # Behind a line with the number of terms, which each of the equations has.
                count = out.pop()
                out += [row for node in sets[fields[0].upper()] for row in (count, ", ".join([str(node), *fields[1:]]))]
                continue
        out.append(line)
    return "\n".join(out) + "\n"


def suite(folder, directory):
    """The decks of a suite that have static steps alone, unpacked."""
    decks = []
    for path in sorted([*folder.glob("*.inp"), *folder.glob("*.inp.gz")]):
        raw = gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes()
        text = raw.decode("latin-1")
        name = path.name.removesuffix(".gz")
        (directory / name).write_text(text)
        if re.search(r"(?im)^\*static", text) and not re.search(OTHER_PROCEDURES, text):
            decks.append(directory / name)
    return decks


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    here = Path(__file__).parent
    arguments.add_argument("decks", nargs="*", type=Path, help="input decks; by default those of the folder decks")
    arguments.add_argument("--suite", type=Path, help="a folder of decks of CalculiX' own tests: those that can be translated are run")
    arguments.add_argument("--seconds", type=float, default=600, help="how long a run of either program may take")
    arguments.add_argument("--directory", type=Path, default=here / "../../target/input_decks")
    arguments.add_argument("--program", type=Path, default=here / "../../target/release/asperity")
    arguments.add_argument("--within", type=float, default=1e-3, help="largest difference over the largest displacement")
    arguments = arguments.parse_args()
    program = arguments.program.resolve()
    arguments.directory.mkdir(parents=True, exist_ok=True)
    decks = arguments.decks or sorted((here / "decks").glob("*.inp"))
    if arguments.suite:
        decks = suite(arguments.suite, arguments.directory)
    far, refused = 0, []
    print("| deck | largest displacement | largest difference over it | root mean square |\n|---|---|---|---|")
    for deck in decks:
        folder = arguments.directory / deck.stem
        folder.mkdir(parents=True, exist_ok=True)
        if not translated(deck, folder, program):
            refused.append(deck.stem)
            continue
        text = deck.read_text()
        if arguments.suite:
            text = printing(spelled(text), [line.split(",")[0] for line in mesh_nodes(folder / f"{deck.stem}.mesh.inp")])
        theirs, own = calculix(text, deck.stem, folder, arguments.seconds), ours(deck, folder, program, arguments.seconds)
        if not theirs or not own:
            print(f"| {deck.stem} | {'' if theirs else 'CalculiX stopped'} {'' if own else 'ours stopped'} | | |", flush=True)
            far += 1
            continue
        common = sorted(set(theirs) & set(own))
        one = np.array([theirs[node] for node in common])
        other = np.array([np.resize(np.append(own[node], 0.0), 3) for node in common])
        # Where nothing moves at the end there is no more than rounding to compare.
        size = max(np.abs(one).max(), 1e-9)
        off = np.abs(one - other)
        print(f"| {deck.stem} | {size:.4g} | {off.max() / size:.1e} | {np.sqrt((off**2).mean()) / size:.1e} |", flush=True)
        far += off.max() > arguments.within * size
    if refused:
        print(f"\n{len(refused)} of {len(decks)} cannot be translated: {', '.join(refused)}")
    print(f"\n{far} beyond {arguments.within}")
    sys.exit(1 if far else 0)


if __name__ == "__main__":
    main()
