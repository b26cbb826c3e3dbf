#!/usr/bin/env python3
"""What a rank of two takes beside one rank that has all: a cube of rubber, pressed and sheared by a tenth, factorised by MUMPS.

    cargo build --release -p asperity-cli --features asperity-cli/cluster
    python3 benches/iterative/ranks.py [--program PATH] [--own PATH] [--directory DIR] [--cells N] [--times N]

Runs on one rank and on two in turn, and by the library's own solver on two threads beside them where --own names a program without that feature;
medians of the processor time (of two ranks that of the busier) and of the largest memory of a rank. Exit code 1 where two ranks take more than 0.6
of the time or 0.65 of the memory of one.
"""
import argparse
import pathlib
import statistics
import subprocess
import sys

from iterative import BODIES, CUBE, ROOT

MOST_TIME = 0.6
MOST_MEMORY = 0.65


def taken(options, ranks, name):
    """Processor time in seconds and memory in GiB, each the largest of all ranks."""
    used = options.directory / f"{name}.taken"
    used.unlink(missing_ok=True)
    words = ["mpirun", "--oversubscribe", "--mca", "mpi_yield_when_idle", "1", "-n", str(ranks)] if ranks else []
    words += [sys.executable, str(pathlib.Path(__file__).with_name("iterative.py")), "--rank", str(used.resolve())]
    words += [options.program if ranks else options.own, "run", "cube.toml", "--out", name, "--threads", "1" if ranks else "2", "--no-report"]
    with open(options.directory / f"{name}.log", "w", encoding="utf8") as log:
        subprocess.run(words, cwd=options.directory, stdout=log, stderr=subprocess.STDOUT, check=True)
    lines = [line.split() for line in used.read_text(encoding="ascii").splitlines()]
    return [max(float(line[column]) for line in lines) for column in (1, 2)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", default=str(ROOT / "target/release/asperity"))
    parser.add_argument("--own")
    parser.add_argument("--directory", type=pathlib.Path, default=ROOT / "target/iterative/ranks")
    parser.add_argument("--cells", type=int, default=36)
    parser.add_argument("--times", type=int, default=3)
    options = parser.parse_args()
    options.directory.mkdir(parents=True, exist_ok=True)
    _, cell, law, _, move = BODIES["standard"]
    text = CUBE.format(n=options.cells, cell=cell, law=law, formulation="auto", move=move, solver="")
    (options.directory / "cube.toml").write_text(text.replace('solver.petsc = ""\n', ""), encoding="ascii")
    kinds = {"MUMPS, one rank": 1, "MUMPS, two ranks": 2} | ({"own solver, two threads": 0} if options.own else {})
    runs = {kind: [] for kind in kinds}
    for time in range(options.times):
        for kind, ranks in kinds.items():
            seconds, memory = taken(options, ranks, f"ranks{ranks}")
            runs[kind].append((seconds, memory))
            print(f"{time + 1}  {kind:24}{seconds:8.1f} s{memory:8.3f} GiB", flush=True)
    median = {kind: [statistics.median(column) for column in zip(*all_of)] for kind, all_of in runs.items()}
    one, two = median["MUMPS, one rank"], median["MUMPS, two ranks"]
    ratios = [b / a for a, b in zip(one, two)]
    print(f"a rank of two over one, medians: time {ratios[0]:.3f} ({MOST_TIME}), memory {ratios[1]:.3f} ({MOST_MEMORY})")
    return 0 if ratios[0] <= MOST_TIME and ratios[1] <= MOST_MEMORY else 1


if __name__ == "__main__":
    sys.exit(main())
