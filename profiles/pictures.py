#!/usr/bin/env python3
"""Draws profiles/NAME/*.svg of bodies under an eccentric force: python3 profiles/pictures.py PROGRAM NAME...

Needs numpy, h5py and gnuplot (Debian: python3-h5py gnuplot-nox); nothing else in the repository needs this program.
PROGRAM is `brinell`. Along the line y = 0, between the two middle rows, the pressure is their mean. The edge of the
contact in a column of nodes is where the square of the pressure, which falls linearly there, becomes zero.
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import tomllib

import h5py
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent

# x is divided by this length, and so is the eccentricity; y and pressures are in these units.
STYLES = {
    "flat_punch": {"length": lambda surface: surface["radius"], "name": "R", "y": (5e-3, "y / R"),
                   "pressure": (1e6, "MPa"), "more": "set size ratio -1\n"},
    "roller": {"length": lambda surface: surface["straight_length"] / 2, "name": "L", "y": (1e-6, "y [µm]"),
               "pressure": (1e9, "GPa"), "more": ""}}


def solve(program, folder):
    with tempfile.TemporaryDirectory() as out:
        subprocess.run([program, "run", folder, "--out", out, "--quiet"], check=True)
        increments = json.loads((pathlib.Path(out) / "summary.json").read_text())["increments"]
        with h5py.File(pathlib.Path(out) / "fields.h5") as file:
            pressures = [file[f"step_{i['step']}/increment_{i['increment']}/pressure"][()] for i in increments]
            return increments, pressures, tuple(file.attrs["spacing"][:2])


def half_widths(pressure, y):
    """Of the contact in each column; NaN where there is none."""
    widths = np.full(pressure.shape[1], np.nan)
    spacing = y[1] - y[0]
    for column in np.flatnonzero((pressure > 0).any(axis=0)):
        last = np.flatnonzero(pressure[:, column] > 0)[-1]
        outer, inner = pressure[last, column]**2, pressure[last - 1, column]**2
        beyond = min(outer / (inner - outer), 1) if inner > outer else 0.5
        widths[column] = y[last] + beyond * spacing
    return widths


def draw(path, script, blocks):
    """blocks: (title, array of two columns) of each curve."""
    data = "".join(f"$d{k} << EOD\n" + "\n".join(f"{a:.5g} {b:.5g}" for a, b in block) + "\nEOD\n"
                   for k, (_, block) in enumerate(blocks))
    curves = ", ".join(f"$d{k} with lines lw 1.5 lc palette cb {k} title '{title}'" if "palette" in script else
                       f"$d{k} {title}" for k, (title, _) in enumerate(blocks))
    text = (f"set terminal svg size 640,400 enhanced font 'sans,12' background 'white'\nset output '{path}'\n"
            f"set grid lc rgb '#dddddd'\nset border lc rgb '#666666'\n{script}{data}plot {curves}\n")
    subprocess.run(["gnuplot"], input=text, text=True, check=True)
    path.write_text("\n".join(line.rstrip() for line in path.read_text().splitlines()) + "\n")


def pictures(program, folder):
    scene = tomllib.loads((folder / "scene.toml").read_text())
    surface = scene["surface"][0]
    style = STYLES[surface["shape"]]
    length, name = style["length"](surface), style["name"]
    increments, pressures, (dx, dy) = solve(program, folder)
    ny, nx = pressures[0].shape
    x, y = (np.arange(nx) - (nx - 1) / 2) * dx / length, (np.arange(ny) - (ny - 1) / 2) * dy
    e = [step["eccentricity"][0] / length for step in scene["step"]]
    titles = [f"e = {value:.1f}" for value in e]
    many = (f"set palette defined (0 '#1f4e99', 1 '#2a9d8f', 2 '#e9a23b', 3 '#c0392b')\nunset colorbox\n"
            f"set cbrange [0:{len(e) - 1}]\nset xlabel 'x / {name}'\nset key outside right\n")

    scale, unit = style["pressure"]
    middle = [(p[(ny - 1) // 2] + p[ny // 2]) / 2 for p in pressures]
    draw(folder / "pressure.svg", many + f"set ylabel 'pressure at y = 0 [{unit}]'\n",
         [(t, np.column_stack([x, p / scale])) for t, p in zip(titles, middle)])

    scale, label = style["y"]
    outlines = []
    for title, pressure in zip(titles, pressures):
        width = half_widths(pressure, y) / scale
        inside = ~np.isnan(width)
        around = np.concatenate([np.column_stack([x, width])[inside], np.column_stack([x, -width])[inside][::-1]])
        outlines.append((title, np.vstack([around, around[:1]])))
    draw(folder / "contact.svg", many + style["more"] + f"set ylabel '{label}'\n", outlines)

    tilt = np.array([-i["tilt"][0] for i in increments])
    closed = tilt[1] / e[1] * np.array(e)
    draw(folder / "tilt.svg",
         f"set key left top\nset yrange [0:]\nset xlabel 'eccentricity e = x0 / {name}'\nset ylabel 'tilt [10^{{-6}} rad]'\n",
         [("with lines dt 2 lc rgb '#888888' title 'proportional to e'", np.column_stack([e, closed * 1e6])),
          ("with linespoints pt 7 lw 1.5 lc rgb '#1f4e99' title 'tilt'", np.column_stack([e, tilt * 1e6]))])


def main(arguments):
    if len(arguments) < 2:
        sys.exit("usage: pictures.py PROGRAM NAME...")
    for name in arguments[1:]:
        pictures(arguments[0], HERE / name)


if __name__ == "__main__":
    main(sys.argv[1:])
