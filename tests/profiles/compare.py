"""Runs a profile by the command line and compares its summary with its reference.json.

    compare.py FOLDER               every increment's certificate and every quantity of the reference
    compare.py --self-test FOLDER   the same, then with references and summaries made wrong, each of which must be told

Exit status 0 if all agrees. The program's path comes from the variable BRINELL_PROGRAM. |result - value| <= tolerance,
in the quantity's own unit; a quantity of two values is compared by component.
"""

import copy
import json
import os
import pathlib
import subprocess
import sys
import tempfile

CERTIFICATE = ("penetration", "complementarity", "tension", "balance")


def certificate_parts(reference):
    """The yield condition is part of it where a body hardens."""
    return CERTIFICATE + (("yield",) if reference.get("hardens") else ())


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def within(result, value, limit):
    """False for whatever is no number, NaN included."""
    return is_number(result) and abs(result - value) <= limit


def difference(name, result, expected):
    """A line that tells by how much a result is off, or None."""
    value, tolerance = expected["value"], expected["tolerance"]
    values = value if isinstance(value, list) else [value]
    results = result if isinstance(value, list) and isinstance(result, list) else [result]
    if len(results) == len(values) and all(within(r, v, tolerance) for r, v in zip(results, values)):
        return None
    return f"{name} is {result}, expected {value} within {tolerance} ({expected['source']})"


def differences(reference, summary):
    """What is wrong with a summary, a line each."""
    found = []
    if summary.get("converged") is not True:
        found.append(f"converged is {summary.get('converged')}, expected True")
    increments, expected = summary.get("increments", []), reference["increments"]
    if not expected or len(increments) != len(expected):
        found.append(f"{len(increments)} increments, expected {len(expected)}, at least 1")
    for result, wanted in zip(increments, expected):
        place = f"step {wanted['step']} increment {wanted['increment']}: "
        for key in ("step", "increment"):
            if result.get(key) != wanted[key]:
                found.append(f"{place}{key} is {result.get(key)}")
        for part in certificate_parts(reference):
            value = result.get("certificate", {}).get(part)
            if not within(value, 0, reference["certificate"]):
                found.append(f"{place}certificate: {part} is {value}, expected at most {reference['certificate']}")
        quantities = {k: v for k, v in wanted.items() if k not in ("step", "increment")}
        if not quantities:
            found.append(f"{place}the reference holds no quantity")
        for name, quantity in quantities.items():
            if quantity["source"] not in reference["sources"]:
                found.append(f"{place}{name}: the source '{quantity['source']}' is not explained")
            line = difference(name, result.get(name), quantity)
            if line:
                found.append(place + line)
    return found


def run(folder):
    """The summary of a run of the profile; ends the program if the exit status is not 0."""
    with tempfile.TemporaryDirectory(prefix="brinell_") as scratch:
        result = subprocess.run([os.environ["BRINELL_PROGRAM"], "run", folder, "--out", scratch + "/out", "--json"],
                                capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"{folder}: brinell run ended with status {result.returncode}\n{result.stderr}")
    return json.loads(result.stdout)


def falsified(reference, summary):
    """(what was done, reference, summary) for every kind of wrong that must be told."""
    first = reference["increments"][0]
    for name in (k for k in first if k not in ("step", "increment")):
        for sign in (-1, 1):
            wrong = copy.deepcopy(reference)
            result = summary["increments"][0][name]
            wrong["increments"][0][name]["value"] = result + sign * 1.001 * (first[name]["tolerance"] or 1)
            yield f"{name} just out of tolerance", wrong, summary
        for nothing in (None, float("nan"), "1"):
            wrong = copy.deepcopy(summary)
            wrong["increments"][-1][name] = nothing
            yield f"{name} is {nothing!r}", reference, wrong
        wrong = copy.deepcopy(summary)
        del wrong["increments"][-1][name]
        yield f"{name} is missing", reference, wrong
    for part in certificate_parts(reference):
        for value in (1.001 * reference["certificate"], None, float("nan")):
            wrong = copy.deepcopy(summary)
            wrong["increments"][-1]["certificate"][part] = value
            yield f"certificate: {part} is {value}", reference, wrong
    yield "not converged", reference, {**summary, "converged": False}
    yield "last increment is missing", reference, {**summary, "increments": summary["increments"][:-1]}
    yield "no increments", reference, {**summary, "increments": []}
    yield "increments out of order", reference, {**summary, "increments": summary["increments"][::-1]}
    yield "empty reference", {**reference, "increments": []}, {**summary, "increments": []}
    yield "unexplained source", {**reference, "sources": {}}, summary


def self_test(folder, reference, summary):
    untold = [what for what, wrong, result in falsified(reference, summary) if not differences(wrong, result)]
    with tempfile.TemporaryDirectory(prefix="brinell_") as scratch:
        (pathlib.Path(scratch) / "scene.toml").write_text(
            (pathlib.Path(folder) / "scene.toml").read_text() + "\n[solver]\nmax_iterations = 1\ntolerance = 1e-14\n")
        try:
            run(scratch)
            untold.append("an exit status other than 0")
        except SystemExit:
            pass
    return [f"not told: {what}" for what in untold]


def main(arguments):
    tests_itself = arguments[:1] == ["--self-test"]
    folder = arguments[-1]
    reference = json.loads((pathlib.Path(folder) / "reference.json").read_text())
    summary = run(folder)
    found = differences(reference, summary)
    if tests_itself:
        found += self_test(folder, reference, summary)
    for line in found:
        print(f"{folder}: {line}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
