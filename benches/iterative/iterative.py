#!/usr/bin/env python3
"""Iterations of FGMRES with BoomerAMG on the matrices of runs: against size, against the penalty of a contact, and on other bodies.

    cargo build --release -p asperity-cli --features asperity-cli/cluster
    python3 benches/iterative/iterative.py [--program PATH] [--directory DIR] [--ranks N] [--sizes N,..] [--cells N] [--penalties X,..] [--bodies NAME,..]

Sizes: a cube of n^3 hex8 of neo-Hookean rubber into which a ball is pressed and along which it is then dragged with friction, one increment
each, with the contact's own penalty, 67 E / h. Penalties: the same with N^3 cells of --cells and these multiples of E / h (E = 1, h the edge of a cell). Bodies: cubes of as
many, in cells of second degree of half as many along an edge, pressed and sheared by a tenth (by a hundredth where it flows), without contact. Each solution ends at 1e-8 of its right-hand side; what is printed of residuals are true ones, |b - A x| / |b|.
Time and memory are those of each rank. Exit code 1 where a run does not come to its end.
"""
import argparse
import json
import os
import pathlib
import re
import resource
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOLVER = "-ksp_type fgmres -pc_type hypre -pc_hypre_boomeramg_strong_threshold 0.5 -ksp_monitor_true_residual"
RUBBER = "neo_hookean = { shear = 0.385, bulk = 0.833 }"
PUNCH = """version = 1
space = "solid"
mesh.part.cube.box = {{ from = [0.0, 0.0, 0.0], to = [1.0, 1.0, 1.0], cells = [{n}, {n}, {n}], cell = "hex8" }}
material.rubber.{rubber}
body.cube.material = "rubber"
tool.punch.sphere = {{ center = [0.5, 2.0, 0.5], radius = 1.0 }}
contact.top = {{ surface = "cube.top", target = "punch", law.coulomb = {{ friction = 0.3 }}{penalty} }}
solver = {{ piecewise = false, petsc = "{solver}" }}
[[step]]
name = "press"
displacement."cube.bottom" = {{ x = 0.0, y = 0.0, z = 0.0 }}
motion.punch = {{ y = -0.02 }}
increments.count = 1
[[step]]
name = "drag"
motion.punch = {{ x = 0.02 }}
increments.count = 1
"""
CUBE = """version = 1
space = "solid"
mesh.part.cube.box = {{ from = [0.0, 0.0, 0.0], to = [1.0, 1.0, 1.0], cells = [{n}, {n}, {n}], cell = "{cell}" }}
material.one.{law}
body.cube.material = "one"
body.cube.formulation = "{formulation}"
solver.petsc = "{solver}"
[[step]]
displacement."cube.bottom" = {{ x = 0.0, y = 0.0, z = 0.0 }}
displacement."cube.top" = {{ x = {move}, y = -{move}, z = 0.0 }}
increments.count = 1
"""
STEEL = "von_mises = { young = 1.0, poisson = 0.3, yield_stress = 0.002, hardening = 0.01 }"
BODIES = {
    "standard": (1, "hex8", RUBBER, "standard", 0.1),
    "incompatible": (1, "hex8", RUBBER, "incompatible", 0.1),
    "plastic": (1, "hex8", STEEL, "f-bar", 0.01),
    "incompressible": (1, "hex8", "neo_hookean = { shear = 0.385, bulk = 385.0 }", "f-bar", 0.1),
    "hex20": (2, "hex20", RUBBER, "standard", 0.1),
    "tet10": (2, "tet10", RUBBER, "standard", 0.1),
}


def rank(words):
    """Runs a program as one rank does, and notes what it took."""
    code = subprocess.call(words[1:])
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    line = f"{os.environ.get('OMPI_COMM_WORLD_RANK', '0')} {used.ru_utime + used.ru_stime:.1f} {used.ru_maxrss / 2**20:.3f}\n"
    with open(words[0], "a", encoding="ascii") as file:
        file.write(line)
    return code


def run(options, name, text):
    """Runs a deck and prints a line of the table."""
    folder = options.directory / name
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "deck.toml").write_text(text)
    taken = folder / "taken"
    taken.unlink(missing_ok=True)
    words = ["mpirun", "--oversubscribe", "--mca", "mpi_yield_when_idle", "1", "-n", str(options.ranks)]
    words += [sys.executable, __file__, "--rank", str(taken.resolve()), options.program, "run", "deck.toml"]
    words += ["--out", "out", "--threads", "1", "--no-report"]
    with open(folder / "log", "w", encoding="utf8") as log:
        subprocess.run(words, cwd=folder, stdout=log, stderr=subprocess.STDOUT, check=False)
    solutions = []
    for line in (folder / "log").read_text(errors="replace").splitlines():
        found = re.search(r"^ *(\d+) KSP .*true resid norm.*\|\|r\(i\)\|\|/\|\|b\|\| *(\S+)", line)
        if found:
            if int(found[1]) == 0:
                solutions.append((0, 0.0))
            elif solutions:
                solutions[-1] = (int(found[1]), float(found[2]))
    solutions = [solution for solution in solutions if solution[0] > 0]
    summary = json.loads((folder / "out/summary.json").read_text()) if (folder / "out/summary.json").exists() else {}
    well = summary.get("status") in ("converged", "doubtful")
    ranks = sorted(line.split() for line in taken.read_text().splitlines()) if taken.exists() else []
    counts = [count for count, _ in solutions] or [0]
    left = max((left for _, left in solutions), default=float("nan"))
    print(
        f"{name:22}{summary.get('unknowns', 0):9}{summary.get('iterations', 0):8}{len(solutions):11}"
        f"{min(counts):6} to {max(counts):<4}{left:11.1e}  {', '.join(r[1] for r in ranks):>15}  {', '.join(r[2] for r in ranks)}",
        flush=True,
    )
    return well


def main():
    if sys.argv[1:2] == ["--rank"]:
        return rank(sys.argv[2:])
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", default=str(ROOT / "target/release/asperity"))
    parser.add_argument("--directory", type=pathlib.Path, default=ROOT / "target/iterative")
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--sizes", default="12,24,36,48,60")
    parser.add_argument("--cells", type=int, default=24)
    parser.add_argument("--penalties", default="7,10,70,700,1000")
    parser.add_argument("--bodies", default=",".join(BODIES))
    options = parser.parse_args()
    head = f"{'':22}{'unknowns':>9}{'Newton':>8}{'solutions':>11}{'iterations':>14}{'residual':>11}  {'s of a rank':>15}  GiB of a rank"
    print(head, flush=True)
    runs = [(f"size {n}", PUNCH.format(n=n, rubber=RUBBER, penalty="", solver=SOLVER)) for n in listed(options.sizes)]
    for times in listed(options.penalties):
        penalty = f", penalty = {float(times) * options.cells}"
        runs.append((f"penalty {times} E over h", PUNCH.format(n=options.cells, rubber=RUBBER, penalty=penalty, solver=SOLVER)))
    for name in listed(options.bodies):
        part, cell, law, formulation, move = BODIES[name]
        text = CUBE.format(n=options.cells // part, cell=cell, law=law, formulation=formulation, move=move, solver=SOLVER)
        runs.append((name, text))
    return 0 if all([run(options, name, text) for name, text in runs]) else 1


def listed(words):
    return [word for word in words.split(",") if word]


if __name__ == "__main__":
    sys.exit(main())
