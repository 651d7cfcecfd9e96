#!/usr/bin/env python3
"""What the size of the increments does to a scene whose bodies harden, as Markdown tables:

    python3 profiles/increments.py PROGRAM FOLDER

The first step of FOLDER/scene.toml alone, in 2 to 128 increments, then in one that increment_tolerance divides; the
certificate is 1e-8, so that it does not count. Differences are from the solution in 128 increments, the order is that
of the largest pressure between a column and the one before. CPU is the whole program's, one thread.
"""

import json
import math
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

COUNTS = (2, 4, 8, 16, 32, 64, 128)
TOLERANCES = ("1e-2", "3e-3", "1e-3", "3e-4")


def variant(text, increments, tolerance):
    """The scene's first step in so many increments, divided for the tolerance if there is one."""
    head, first, *_ = text.split("[[step]]")
    rest = re.search(r"(?ms)^\[(?:solver|output)\].*", text)[0]
    first = re.sub(r"(?ms)^\[(?:solver|output)\].*", "", first)
    first = re.sub(r"(?m)^increments *=.*$", f"increments = {increments}", first)
    line = f"\nincrement_tolerance = {tolerance}" if tolerance else ""
    rest = re.sub(r"(?m)^tolerance *=.*$", "tolerance = 1e-8" + line, rest)
    rest = re.sub(r"(?ms)^\[output\].*", "", rest)
    return head + "[[step]]" + first + rest


def run(program, folder, increments, tolerance=None):
    """The last increment's summary, with what all of them took."""
    with tempfile.TemporaryDirectory() as scratch:
        scene = pathlib.Path(scratch) / "scene.toml"
        scene.write_text(variant((pathlib.Path(folder) / "scene.toml").read_text(), increments, tolerance))
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        out = subprocess.run([program, "run", scene, "--out", pathlib.Path(scratch) / "out", "--json", "--quiet",
                              "--threads", "1"], check=True, capture_output=True, text=True).stdout
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    result = json.loads(out)["increments"]
    last = dict(result[-1])
    last["cpu"] = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    last["parts"] = sum(i["substeps"] for i in result)
    last["estimate"] = max(i["increment_error"] for i in result)
    return last


def table(names, columns, rows):
    print("| " + names + " | " + " | ".join(columns) + " |")
    print("|---" * (len(columns) + 1) + "|")
    for name, values in rows:
        print("| " + name + " | " + " | ".join(values) + " |")
    print()


def rows_of(results, fine):
    def difference(result, key):
        return f"{(result[key] - fine[key]) / fine[key]:+.1e}" if result is not fine else ""
    return [("interference [nm]", [f"{r['approach'] * 1e9:.3f}" for r in results]),
            ("largest pressure [GPa]", [f"{r['max_pressure'] * 1e-9:.4f}" for r in results]),
            ("difference of the interference", [difference(r, "approach") for r in results]),
            ("difference of the pressure", [difference(r, "max_pressure") for r in results]),
            ("largest `increment_error`", [f"{r['estimate']:.1e}" for r in results]),
            ("CPU [s]", [f"{r['cpu']:.1f}" for r in results])]


if __name__ == "__main__":
    runs = [run(*sys.argv[1:3], n) for n in COUNTS]
    wrong = [abs(r["max_pressure"] - runs[-1]["max_pressure"]) for r in runs[:-1]]
    orders = [""] + [f"{math.log2(a / b):.1f}" for a, b in zip(wrong, wrong[1:])] + [""]
    table("increments", [str(n) for n in COUNTS], rows_of(runs, runs[-1]) + [("observed order", orders)])
    steered = [run(*sys.argv[1:3], 1, t) for t in TOLERANCES]
    table("`increment_tolerance`", TOLERANCES,
          [("parts", [str(r["parts"]) for r in steered]), *rows_of(steered, runs[-1])])
