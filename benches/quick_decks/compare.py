#!/usr/bin/env python3
"""Runs the quick decks with two binaries in turn and compares iterations, failed attempts and processor time.

    python3 benches/quick_decks/compare.py OLD NEW [--limit SECONDS] [WORD ...]

OLD and NEW are two builds of the command `asperity`. Each deck of decks.txt (or those whose line holds a WORD) is run by both
on one thread, one after the other, and the sums are printed at the end, over the decks that both finish. Exit code 1 where a
sum is larger than before by more than a hundredth, or a deck does not end that did.
"""
import argparse
import json
import resource
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
CASES = HERE.parent.parent / "cases"


def decks(words):
    """The decks of the list: a path below `cases` and what is set in it, as a shell would read it."""
    lines = [line.strip() for line in (HERE / "decks.txt").read_text().splitlines()]
    lines = [line for line in lines if line and not line.startswith("#")]
    return [line for line in lines if not words or any(word in line for word in words)]


def run(binary, line, limit):
    """Iterations, failed attempts, seconds of processor time, and how the run ended."""
    deck, *sets = shlex.split(line)
    with tempfile.TemporaryDirectory() as folder:
        command = [binary, "run", str(CASES / deck), "--threads", "1", "--out", folder + "/out"]
        command += [word for value in sets for word in ("--set", value)]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        try:
            code = subprocess.run(command, capture_output=True, timeout=limit, check=False).returncode
        except subprocess.TimeoutExpired:
            code = "time"
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        summary = Path(folder, "out", "summary.json")
        summary = json.loads(summary.read_text()) if summary.exists() else {}
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    counts = [summary.get(key, 0) for key in ("iterations", "attempts", "increments")]
    return counts[0], counts[1] - counts[2], seconds, code


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("words", nargs="*")
    parser.add_argument("--limit", type=float, default=300.0, help="seconds a deck may take")
    options = parser.parse_args()
    sums, lost = [[0, 0, 0.0], [0, 0, 0.0]], []
    print(f"{'':60} {'iterations':>15} {'failed':>11} {'seconds':>15}")
    for line in decks(options.words):
        results = [run(binary, line, options.limit) for binary in (options.old, options.new)]
        (old, new), ends = (result[:3] for result in results), [result[3] for result in results]
        counts = f"{old[0]:7} {new[0]:7} {old[1]:5} {new[1]:5} {old[2]:7.1f} {new[2]:7.1f}"
        print(f"{line[:60]:60} {counts}  {'' if ends == [0, 0] else ends}", flush=True)
        if ends[0] == 0 and ends[1] != 0:
            lost.append(line)
        if ends == [0, 0]:
            for total, result in zip(sums, (old, new)):
                total[:] = [a + b for a, b in zip(total, result)]
    old, new = sums
    print(f"{'sum of the decks that both end':60} {old[0]:7} {new[0]:7} {old[1]:5} {new[1]:5} {old[2]:7.1f} {new[2]:7.1f}")
    for line in lost:
        print(f"does not end any more: {line}")
    return 1 if lost or new[0] > 1.01 * old[0] or new[2] > 1.01 * old[2] else 0


if __name__ == "__main__":
    sys.exit(main())
