#!/usr/bin/env python3
"""What half and twice of every number that tunes the procedure do to the iterations of quick decks.

    python3 benches/quick_decks/constants.py [--directory DIR] [--profile quick] [--jobs 1] [WORD ...]

The numbers are those of `crates/core/src/solve/constants.rs`. The sources are copied below DIR, the numbers in the copy are read
from the environment, the program is built there once, and each number is halved and doubled, one at a time, in the decks of SETS below.
Printed are iterations of all attempts that both runs end, failed attempts, and decks that do not end any more. WORDs pick numbers whose
`module::NAME` holds one of them. Also: first guesses by rigid wholes left out, and tangents with the stresses of the iterate in place of
those that the step leads to.
"""
import argparse
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parents[2]
SETS = """billet/sticking.toml mesh.part.billet.rectangle.cells='[8, 12]'
capstan/belt.toml
crushed-ring/half.toml
dragged-ball/slab.toml mesh.part.slab.box.cells='[12, 6, 3]' step.drag.increments.count=6
o-ring/o-ring.toml
ring-compression/ring.toml
roller/roller.toml"""
# What no iteration of these decks asks for: predictions, messages, what is looked at before or after them, paths and relaxations.
LEFT_OUT = {"cycles", "demand", "frontal", "path", "relaxation", "rigid_motions", "snaps", "stability", "stops"}
TUNE = """
/// The number of the environment that takes the place of one of the table.
pub fn tune(name: &str) -> Option<f64> {
    static SAID: std::sync::LazyLock<std::collections::HashMap<String, f64>> = std::sync::LazyLock::new(|| {
        let text = std::env::var("TUNE").unwrap_or_default();
        let pairs = text.split(',').filter_map(|pair| pair.split_once('='));
        pairs.filter_map(|(name, value)| Some((name.to_owned(), value.parse().ok()?))).collect()
    });
    SAID.get(name).copied()
}
"""


def opened(solve):
    """Turns the constants below `solve` into functions that ask the environment, and lists them."""
    table, numbers, modules = TUNE, [], {}
    for module, body in re.findall(r"pub mod (\w+) \{(.*?)\n\}", (solve / "constants.rs").read_text(), re.S):
        if module in LEFT_OUT:
            table += f"pub mod {module} {{{body}\n}}\n"
            continue
        modules[module] = found = re.findall(r"pub const (\w+): ([^=]+) = ([^;]+);", body)
        lines = [f'pub fn {n}() -> {t} {{ super::tune("{module}::{n}").map_or({v}, |x| x as {t}) }}' for n, t, v in found]
        table += f"#[allow(non_snake_case)]\npub mod {module} {{\n" + "\n".join(lines) + "\n}\n"
        numbers += [(f"{module}::{n}", t.strip(), eval(v.replace("_", ""))) for n, t, v in found]
    (solve / "constants.rs").write_text(table)
    for path in solve.rglob("*.rs"):
        text = path.read_text()
        used = re.findall(r"use (?:super::)+constants::(\w+)::\{?([^;}]+)\}?;", text)
        names = [name.strip() for module, names in used if module in modules for name in names.split(",")]
        lines = text.split("#[cfg(test)]")[0].split("\n")
        for name in names:
            lines = [line if re.match(r"\s*(use |//)", line) else re.sub(rf'(?<![\w:"]){name}\b(?!\()', name + "()", line)
                     for line in lines]
        if names:
            path.write_text("\n".join(lines))
    newton = solve / "newton.rs"
    acting = "acting: self.memory.mip.acting()"
    text = newton.read_text()
    assert acting in text, "the tangents' stresses are elsewhere now"
    newton.write_text(text.replace(acting, 'acting: if super::constants::tune("mip").is_some() { &[] } else { self.memory.mip.acting() }'))
    return numbers


def built(directory, profile):
    copy = directory / "sources"
    shutil.rmtree(copy, ignore_errors=True)
    copy.mkdir(parents=True)
    for name in ("Cargo.toml", "Cargo.lock", "rustfmt.toml"):
        shutil.copy(ROOT / name, copy)
    shutil.copytree(ROOT / "crates", copy / "crates")
    numbers = opened(copy / "crates/core/src/solve")
    environment = dict(os.environ, CARGO_TARGET_DIR=str(directory / "target"))
    subprocess.run(["cargo", "build", "--profile", profile, "-p", "asperity-cli"], cwd=copy, env=environment, check=True)
    return directory / "target" / profile / "asperity", numbers


def run(program, line, tune):
    """Iterations, failed attempts, and whether the run ended as it should."""
    deck, *sets = shlex.split(line)
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "run", str(ROOT / "cases" / deck), "--threads", "1", "--quiet", "--no-report", "--out", folder + "/out"]
        command += [word for value in sets for word in ("--set", value)]
        try:
            code = subprocess.run(command, env=dict(os.environ, TUNE=tune), capture_output=True, timeout=900, check=False).returncode
        except subprocess.TimeoutExpired:
            return 0, 0, False
        summary = json.loads(pathlib.Path(folder, "out", "summary.json").read_text())
    return summary["iterations"], summary["attempts"] - summary["increments"], code in (0, 6)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("words", nargs="*", metavar="WORD")
    parser.add_argument("--directory", type=pathlib.Path, default=ROOT / "target/constants")
    parser.add_argument("--profile", default="quick")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--built", nargs=2, metavar=("PROGRAM", "NUMBERS"), help="a program built before, and its list of numbers")
    options = parser.parse_args()
    if options.built:
        program, numbers = options.built[0], [tuple(row) for row in json.loads(pathlib.Path(options.built[1]).read_text())]
    else:
        program, numbers = built(options.directory.resolve(), options.profile)
        (options.directory / "numbers.json").write_text(json.dumps(numbers))
    decks = SETS.splitlines()
    pool = ThreadPoolExecutor(options.jobs)
    plain = dict(zip(decks, pool.map(lambda deck: run(program, deck, ""), decks)))
    print(f"plain: {sum(result[0] for result in plain.values())} iterations, {sum(result[1] for result in plain.values())} failed attempts")
    cases = [(f"{name} = {value:g}", f"{name}={value!r}") for name, kind, now in numbers
             for value in ([max(1, now // 2), 2 * now] if kind != "f64" else [now / 2, now * 2])]
    cases += [("no first guess by rigid wholes", "predictor::GOOD_GUESS=1e99"), ("stresses of the iterate in the tangent", "mip=1")]
    for name, tune in cases:
        if options.words and not any(word in name for word in options.words):
            continue
        results = dict(zip(decks, pool.map(lambda deck: run(program, deck, tune), decks)))
        both = [deck for deck in decks if results[deck][2] and plain[deck][2]]
        change = [sum(results[deck][k] for deck in both) - sum(plain[deck][k] for deck in both) for k in (0, 1)]
        of = sum(plain[deck][0] for deck in both)
        lost = [deck.split()[0] for deck in decks if plain[deck][2] and not results[deck][2]]
        told = f"; do not end: {', '.join(lost)}" if lost else ""
        most = max(both, key=lambda deck: abs(results[deck][0] - plain[deck][0]))
        where = f", most in {most.split()[0]}: {results[most][0] - plain[most][0]:+}" if change[0] else ""
        print(f"{name:48} iterations {change[0]:+6} ({change[0] / of:+.1%}), failed {change[1]:+4}{where}{told}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
