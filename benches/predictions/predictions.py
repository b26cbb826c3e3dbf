#!/usr/bin/env python3
"""What `asperity check` predicts of memory and of the time of a factorisation, beside what the run then takes.

    cargo build --release
    python3 benches/predictions/predictions.py [--program PATH] [--directory DIR] [WORD ...]

Five models from 5 000 to 150 000 unknowns, one thread each: a plane block of second degree with friction, cubes of hex8 and hex20, a
ball dragged with friction over a block, and a cube of 36^3 hex8. Memory is the largest that the process held (its `peak_memory`), against
the prediction for the kind of matrices that the run had; the time is that of all factorisations with their analyses over their number,
as the clock has it, so that the machine should be calm. A WORD picks the models whose names hold it. Exit code 1 where memory is off by
more than a tenth or time by more than a factor of two.
"""
import argparse
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
CUBE = """version = 1
space = "solid"
mesh.part.cube.box = {{ from = [0.0, 0.0, 0.0], to = [1.0, 1.0, 1.0], cells = [{n}, {n}, {n}], cell = "{cell}" }}
material.rubber.neo_hookean = {{ shear = 1.0, bulk = 3.0 }}
body.cube = {{ material = "rubber" }}
[[step]]
increments.count = 2
displacement."cube.bottom" = {{ x = 0.0, y = 0.0, z = 0.0 }}
displacement."cube.top" = {{ x = 0.1, y = 0.0, z = -0.2 }}
"""
PLATE = """version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [8.0, 2.0], cells = [52, 16], cell = "quad8" }
material.steel.elastic = { young = 1e3, poisson = 0.3 }
body.block = { material = "steel", integration = "reduced" }
tool.punch.profile = [{ line = [[-2.0, 2.0], [10.0, 2.0]] }]
contact.cap = { surface = "block.top", target = "punch", law.coulomb = { friction = 0.3 } }
[[step]]
increments.count = 6
displacement."block.bottom" = { x = 0.0, y = 0.0 }
motion.punch = { x = 0.1, y = -0.05 }
"""
SLAB = ["mesh.part.slab.box.cells=[48,18,12]", "step.1.increments.count=2", "step.2.increments.count=4", "step.2.motion.ball.x=0.3"]
MODELS = {
    "plane quad8, friction": (PLATE, []),
    "cube 20^3 hex8": (CUBE.format(n=20, cell="hex8"), []),
    "dragged ball 48 x 18 x 12": (ROOT / "cases/dragged-ball/slab.toml", SLAB),
    "cube 15^3 hex20": (CUBE.format(n=15, cell="hex20"), []),
    "cube 36^3 hex8": (CUBE.format(n=36, cell="hex8"), []),
}


def command(program, verb, deck, sets, *more):
    words = [program, verb, str(deck), *more]
    return words + [word for value in sets for word in ("--set", value)]


def numbers(pattern, text):
    return [float(number) for number in re.search(pattern, text).groups()]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("words", nargs="*", metavar="WORD")
    parser.add_argument("--program", default=str(ROOT / "target/release/asperity"))
    parser.add_argument("--directory", type=pathlib.Path, default=ROOT / "target/predictions")
    options = parser.parse_args()
    environment = dict(os.environ, RAYON_NUM_THREADS="1")
    options.directory.mkdir(parents=True, exist_ok=True)
    print(f"{'':28}{'unknowns':>9}  {'matrices':>12}{'GB said':>9}{'taken':>8}{'':>8}{'s said':>9}{'taken':>8}{'':>7}")
    well = True
    for name, (deck, sets) in MODELS.items():
        if options.words and not any(word in name for word in options.words):
            continue
        if isinstance(deck, str):
            path = options.directory / f"{name.split(',')[0].replace(' ', '_').replace('^', '')}.toml"
            path.write_text(deck)
            deck = path
        check = command(options.program, "check", deck, sets)
        said = subprocess.run(check, capture_output=True, text=True, env=environment, check=False).stdout
        memory = numbers(r"memory: about ([\d.e+]+) GB, ([\d.e+]+) GB", said)
        seconds = re.search(r"about ([\d.e+-]+) s on 1 threads, ([\d.e+-]+) s", said)
        out = options.directory / "out"
        run = command(options.program, "run", deck, sets, "--threads", "1", "--out", str(out), "--quiet", "--no-report")
        subprocess.run(run, env=environment, check=False, stdout=subprocess.DEVNULL)
        summary = json.loads((out / "summary.json").read_text())
        count = summary["factorisations"]
        symmetric = int(summary["symmetric_factorisations"] == count)
        taken = summary["peak_memory"] / 1e9
        each = summary["timings"]["factorisation"] / max(count, 1)
        ratio = memory[symmetric] / taken
        kind = f"{count} {'L D L^T' if symmetric else 'L U'}"
        line = f"{name:28}{summary['unknowns']:9}  {kind:>12}{memory[symmetric]:9.3f}{taken:8.3f}{ratio - 1:+8.1%}"
        well &= abs(ratio - 1) <= 0.1
        if seconds:
            expected = float(seconds.groups()[symmetric])
            line += f"{expected:9.2f}{each:8.2f}{expected / each:7.2f}"
            well &= 0.5 <= expected / each <= 2.0
        print(line, flush=True)
    return 0 if well else 1


if __name__ == "__main__":
    sys.exit(main())
