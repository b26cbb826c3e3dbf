#!/usr/bin/env python3
"""Runs the quick decks with two binaries in turn and compares iterations, failed attempts and processor time.

    python3 benches/quick_decks/compare.py OLD NEW [--limit SECONDS] [--formulation KIND] [WORD ...]

OLD and NEW are two builds of the command `asperity`. Each deck of decks.txt (or those whose line holds a WORD) is run by both
on one thread, one after the other, with KIND as the formulation of all bodies if given. The sums are printed at the end, over the
decks that both finish, and what audit and watch of stability take of the time of NEW. Exit code 1 where a sum is larger than before
by more than a hundredth, a deck does not end that did, or one of these takes more than its part of SHARES.
"""
import argparse
import json
import resource
import shlex
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
CASES = HERE.parent.parent / "cases"
# The most that these may take of the time of all runs together.
SHARES = {"audit": 0.03, "stability": 0.02}


def decks(words):
    """The decks of the list: a path below `cases` and what is set in it, as a shell would read it."""
    lines = [line.strip() for line in (HERE / "decks.txt").read_text().splitlines()]
    lines = [line for line in lines if line and not line.startswith("#")]
    return [line for line in lines if not words or any(word in line for word in words)]


def run(binary, line, limit, formulation):
    """Iterations, failed attempts, seconds of processor time, how the run ended, and its `timings`."""
    deck, *sets = shlex.split(line)
    if formulation:
        bodies = tomllib.loads((CASES / deck).read_text())["body"]
        sets += [f"body.{body}.formulation={formulation}" for body in bodies]
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
    return counts[0], counts[1] - counts[2], seconds, code, summary.get("timings", {})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("words", nargs="*")
    parser.add_argument("--limit", type=float, default=300.0, help="seconds a deck may take")
    parser.add_argument("--formulation", help="that of all bodies, in place of what the decks say")
    options = parser.parse_intermixed_args()
    ended = {0, 6}  # converged, doubtful
    sums, lost, spent = [[0, 0, 0.0], [0, 0, 0.0]], [], dict.fromkeys(["run", *SHARES], 0.0)
    print(f"{'':60} {'iterations':>15} {'failed':>11} {'seconds':>15}")
    for line in decks(options.words):
        results = [run(binary, line, options.limit, options.formulation) for binary in (options.old, options.new)]
        (old, new), ends = (result[:3] for result in results), [result[3] for result in results]
        counts = f"{old[0]:7} {new[0]:7} {old[1]:5} {new[1]:5} {old[2]:7.1f} {new[2]:7.1f}"
        print(f"{line[:60]:60} {counts}  {'' if ends == [0, 0] else ends}", flush=True)
        if ends[0] in ended and ends[1] not in ended:
            lost.append(line)
        if ended.issuperset(ends):
            for total, result in zip(sums, (old, new)):
                total[:] = [a + b for a, b in zip(total, result)]
            for phase in spent:
                spent[phase] += results[1][4].get(phase, 0.0)
    old, new = sums
    print(f"{'sum of the decks that both end':60} {old[0]:7} {new[0]:7} {old[1]:5} {new[1]:5} {old[2]:7.1f} {new[2]:7.1f}")
    shares = {phase: spent[phase] / max(spent["run"], 1e-9) for phase in SHARES}
    print(", ".join(f"{phase} {share:.2%} of the time" for phase, share in shares.items()))
    for line in lost:
        print(f"does not end any more: {line}")
    more = new[0] > 1.01 * old[0] or new[2] > 1.01 * old[2] or any(shares[phase] > most for phase, most in SHARES.items())
    return 1 if lost or more else 0


if __name__ == "__main__":
    sys.exit(main())
