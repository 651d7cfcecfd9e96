#!/usr/bin/env python3
"""Writes reference.json of a profile whose bodies harden, by refinement: python3 profiles/refined.py PROGRAM FOLDER...

No closed form exists beyond yield, so that these values are brinell's own, of the same scene on other grids and in more
increments, extrapolated. With V(h) on the two finest grids of spacing h < H, and V1, V2, V4 in 1, 2, 4 times as many
increments of loading on the coarsest grid:

    value = V(h) + (V(h) - V(H)) / ((H/h)^2 - 1)  +  V4 + (V4 - V2)/3 - V1        second order in both
    tolerance = |V - value| + |V(h) - V(H)| + |V4 - V2|                    V: of the profile

and no less than 1e-5 of the value, ten times the certificate, for the contact area no less than 0.7 spacing / contact
radius of it (hertz_sphere). What is elastic is compared with Hertz, tolerances as in hertz_sphere. Two increments of
each pair of spheres have values from finite elements instead, tolerance |V - value| + what their own refinement leaves
open. Summaries are kept in $REFINED, if that is set, and not computed again.
"""

import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

CERTIFICATE = 1e-6
QUANTITIES = ("approach", "contact_area", "max_pressure", "max_equivalent_plastic_strain")
SOURCES = {
    "load": "prescribed in the scene",
    "hertz": "H. Hertz, J. reine angew. Math. 92 (1882) 156-171, below yield. Tolerances as in hertz_sphere",
    "refined": "brinell's own: the same scene on finer grids and in more increments, extrapolated by "
               "profiles/refined.py, which derives the tolerances from the differences",
    "finite_elements": "profiles/two_spheres/finite_elements.py, axisymmetric, which shares nothing with brinell, "
                       "extrapolated over its cells and increments. Tolerance: this profile's difference from it, and "
                       "what that extrapolation leaves open",
    "unloaded": "the bodies are apart",
}

# By profile, step and increment: value and what refinement leaves open.
FINITE_ELEMENTS = {
    "two_spheres": {
        (1, 5): {"max_pressure": (3.919e9, 0.005e9), "max_equivalent_plastic_strain": (1.750e-3, 0.025e-3)},
        (2, 9): {"max_pressure": (5.60e9, 0.02e9), "max_equivalent_plastic_strain": (1.40e-2, 0.02e-2)}},
    "one_elastic": {
        (1, 5): {"max_pressure": (4.015e9, 0.005e9), "max_equivalent_plastic_strain": (1.960e-3, 0.015e-3)},
        (2, 9): {"max_pressure": (6.18e9, 0.02e9), "max_equivalent_plastic_strain": (1.98e-2, 0.03e-2)}},
}


def variant(text, grid_factor, increments_factor):
    """The scene with spacing times grid_factor, the same sides, and more increments wherever it loads."""
    def integers(match):
        numbers = [int(n) for n in re.findall(r"\d+", match[2])]
        scaled = [round(n / grid_factor) for n in numbers]
        if any(abs(s * grid_factor - n) > 1e-9 for s, n in zip(scaled, numbers)):
            raise ValueError(f"{match[0]}: cannot be divided by {grid_factor}")
        return match[1] + (str(scaled) if "[" in match[2] else str(scaled[0]))

    def lengths(match):
        return match[1] + re.sub(r"[\d.]+(e[-+]?\d+)?", lambda n: repr(float(n[0]) * grid_factor), match[2])

    text = re.sub(r"(?m)^((?:nodes|layers) *= *)(.*)$", integers, text)
    text = re.sub(r"(?m)^((?:spacing|layer_thickness) *= *)(.*)$", lengths, text)
    head, *steps = text.split("[[step]]")
    steps = [step if re.search(r"(?m)^normal_force *= *0\.0", step) else
             re.sub(r"(?m)^(increments *= *)(\d+)$", lambda m: m[1] + str(int(m[2]) * increments_factor), step)
             for step in steps]
    return "[[step]]".join([head, *steps])


def summary(program, folder, grid_factor, increments_factor):
    kept = None
    if "REFINED" in os.environ:
        name = re.sub(r"[^\w]", "_", f"{pathlib.Path(folder).resolve().name}_{grid_factor:.3f}_{increments_factor}")
        kept = pathlib.Path(os.environ["REFINED"]) / f"{name}.json"
        if kept.exists():
            return json.loads(kept.read_text())
    with tempfile.TemporaryDirectory() as scratch:
        scene = pathlib.Path(scratch) / "scene.toml"
        scene.write_text(variant((pathlib.Path(folder) / "scene.toml").read_text(), grid_factor, increments_factor))
        out = subprocess.run([program, "run", scene, "--out", pathlib.Path(scratch) / "out", "--json", "--quiet"],
                             check=True, capture_output=True, text=True).stdout
    if kept:
        kept.write_text(out)
    return json.loads(out)


def at(result, counts, step, increment):
    """The increment of a run in more increments that ends at the same load."""
    of_step = [i for i in result["increments"] if i["step"] == step]
    factor = len(of_step) // counts[step]
    return of_step[(increment + 1) * factor - 1]


def hertz(force, modulus, radius, spacing):
    a = (3 * force * radius / (4 * modulus)) ** (1 / 3)
    h = spacing / a
    return {"approach": (a * a / radius, 0.12 * h * h), "contact_area": (math.pi * a * a, 0.7 * h),
            "max_pressure": (1.5 * force / (math.pi * a * a), 0.45 * h * h)}


def quantity(value, tolerance, source):
    return {"value": value, "tolerance": tolerance, "source": source}


def reference(program, folder, grids, elastic):
    runs = {g: summary(program, folder, g, 1) for g in grids}
    more = {n: summary(program, folder, grids[0], n) for n in (2, 4)}
    profile, fine, less_fine, coarse = runs[1], runs[grids[-1]], runs[grids[-2]], runs[grids[0]]
    weight = 1 / ((grids[-2] / grids[-1]) ** 2 - 1)
    spacing = float(re.search(r"(?m)^spacing *= *\[([^,]*),", (pathlib.Path(folder) / "scene.toml").read_text())[1])
    elsewhere = FINITE_ELEMENTS.get(pathlib.Path(folder).resolve().name, {})
    counts = {}
    for i in profile["increments"]:
        counts[i["step"]] = counts.get(i["step"], 0) + 1
    increments = []
    for own in profile["increments"]:
        step, increment = own["step"], own["increment"]
        entry = {"step": step, "increment": increment,
                 "normal_force": quantity(own["normal_force"], CERTIFICATE * abs(own["normal_force"]), "load")}
        closed = hertz(own["normal_force"], *elastic, spacing) if elastic and step == 0 else {}
        for name in QUANTITIES:
            if name in closed:
                value, relative = closed[name]
                entry[name] = quantity(value, relative * value, "hertz")
                continue
            if own["normal_force"] == 0 and name in ("contact_area", "max_pressure"):
                entry[name] = quantity(0.0, 0.0, "unloaded")
                continue
            if name in elsewhere.get((step, increment), {}):
                value, left_open = elsewhere[step, increment][name]
                entry[name] = quantity(value, abs(own[name] - value) + left_open, "finite_elements")
                continue

            def of(run, name=name):
                return at(run, counts, step, increment)[name]
            value = (of(fine) + weight * (of(fine) - of(less_fine)) + of(more[4]) +
                     (of(more[4]) - of(more[2])) / 3 - of(coarse))
            tolerance = abs(own[name] - value) + abs(of(fine) - of(less_fine)) + abs(of(more[4]) - of(more[2]))
            least = 1e-5 * abs(value)
            if name == "contact_area" and value > 0:
                least = 0.7 * spacing / math.sqrt(value / math.pi) * value
            entry[name] = quantity(value, max(tolerance, least), "refined")
        increments.append(entry)
    used = {q["source"] for i in increments for q in i.values() if isinstance(q, dict)}
    title = tomllib.loads((pathlib.Path(folder) / "scene.toml").read_text())["title"]
    return {"title": title, "certificate": CERTIFICATE, "hardens": True,
            "sources": {k: v for k, v in SOURCES.items() if k in used}, "increments": increments}


def written(data):
    """As the other references: a line a quantity."""
    lines = [f' "title": {json.dumps(data["title"])},', f' "certificate": {data["certificate"]},', ' "hardens": true,',
             ' "sources": {']
    lines.append(",\n".join(f"  {json.dumps(k)}: {json.dumps(v)}" for k, v in data["sources"].items()))
    lines += [" },", ' "increments": [']
    lines.append(",\n".join("  {\n" + ",\n".join(f"   {json.dumps(k)}: {json.dumps(v)}" for k, v in i.items()) + "\n  }"
                            for i in data["increments"]))
    return "{\n" + "\n".join(lines) + "\n ]\n}\n"


STEEL = 210e9 / (1 - 0.3**2)
PROFILES = {"two_spheres": ((3 / 2, 1, 2 / 3), (STEEL / 2, 7.5e-3)),
            "one_elastic": ((3 / 2, 1, 2 / 3), (STEEL / 2, 7.5e-3)),
            "rough_indent": ((2, 4 / 3, 1), None)}

if __name__ == "__main__":
    for chosen in sys.argv[2:]:
        grid_factors, contact = PROFILES[pathlib.Path(chosen).resolve().name]
        made = reference(sys.argv[1], chosen, grid_factors, contact)
        (pathlib.Path(chosen) / "reference.json").write_text(written(made))
