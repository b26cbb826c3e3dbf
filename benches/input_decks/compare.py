"""Runs input decks in CalculiX and here and compares the displacements at the end. See README.md."""

import argparse
import os
import re
import subprocess
import sys
from pathlib import Path

import meshio
import numpy as np


def calculix(deck, folder):
    """Displacements by node of the last table of the .dat file; None if it failed."""
    name = deck.stem
    (folder / f"{name}.inp").write_text(deck.read_text())
    environment = dict(os.environ, OMP_NUM_THREADS="1")
    run = subprocess.run(["ccx", name], cwd=folder, capture_output=True, text=True, env=environment, timeout=600)
    (folder / "ccx.log").write_text(run.stdout + run.stderr)
    tables = re.split(r"displacements \(vx,vy,vz\)[^\n]*\n", (folder / f"{name}.dat").read_text())
    if "*ERROR" in run.stdout or len(tables) < 2:
        return None
    # The table ends where the next one begins.
    table = re.split(r"\n\s*[a-zA-Z]", tables[-1])[0]
    rows = [line.split() for line in table.splitlines() if line.strip()]
    return {int(row[0]): np.array(row[1:4], dtype=float) for row in rows if len(row) == 4 and row[0].isdigit()}


def ours(deck, folder, program):
    """Displacements by node at the end of our run; None if it failed."""
    run = subprocess.run([program, "translate", deck.resolve()], cwd=folder, capture_output=True, text=True)
    if run.returncode == 0:
        run = subprocess.run([program, "run", f"{deck.stem}.toml", "--out", "ours"], cwd=folder, capture_output=True, text=True)
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


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    here = Path(__file__).parent
    arguments.add_argument("decks", nargs="*", type=Path, help="input decks; by default those of the folder decks")
    arguments.add_argument("--directory", type=Path, default=here / "../../target/input_decks")
    arguments.add_argument("--program", type=Path, default=here / "../../target/release/asperity")
    arguments.add_argument("--within", type=float, default=1e-3, help="largest difference over the largest displacement")
    arguments = arguments.parse_args()
    program = arguments.program.resolve()
    far = 0
    print("| deck | largest displacement | largest difference over it | root mean square |\n|---|---|---|---|")
    for deck in arguments.decks or sorted((here / "decks").glob("*.inp")):
        folder = arguments.directory / deck.stem
        folder.mkdir(parents=True, exist_ok=True)
        theirs, own = calculix(deck, folder), ours(deck, folder, program)
        if theirs is None or own is None:
            print(f"| {deck.stem} | {'CalculiX stopped' if theirs is None else ''} {'ours stopped' if own is None else ''} | | |")
            far += 1
            continue
        common = sorted(set(theirs) & set(own))
        one = np.array([theirs[node] for node in common])
        other = np.array([np.resize(np.append(own[node], 0.0), 3) for node in common])
        size = np.abs(one).max()
        off = np.abs(one - other)
        print(f"| {deck.stem} | {size:.4g} | {off.max() / size:.1e} | {np.sqrt((off**2).mean()) / size:.1e} |")
        far += off.max() > arguments.within * size
    print(f"\n{far} beyond {arguments.within}")
    sys.exit(1 if far else 0)


if __name__ == "__main__":
    main()
