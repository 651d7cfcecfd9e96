#!/usr/bin/env python3
"""Regenerates profiles/NAME/reference.json by a path of its own: python3 profiles/reference.py PROGRAM NAME...

Needs numpy, scipy and h5py; nothing else in the repository needs this program. PROGRAM is `brinell`, which is asked for
one thing only: the undeformed gap of a synthesised surface. Measured surfaces are read here.

Smooth sphere: the closed form of Hertz. Everything else: the conjugate gradients of Polonsky and Keer (Wear 231, 1999,
206-219) as in the paper, two convolutions an iteration, from a uniform pressure. Where a step says where its force acts,
they solve for given slopes, and Newton's method around them finds the slopes (Spinu and Diaconescu, IJTC 2008), with a
Jacobian by finite differences that Broyden's formula keeps up. Displacement of a free half-space:
u = K * p with the coefficients of a uniformly loaded rectangle (Love, Phil. Trans. R. Soc. A 228, 1929, 377-420; Johnson,
Contact Mechanics, 1985, eq. 3.25) in long double on a grid of twice the size; of a periodic one:
u(q) = 2 p(q) / (E* |q|), u(0) = 0 (Johnson, section 13.2). Deformed gap: gap + u - approach. Lengths in m, pressure in
units of E* inside the solver.
"""

import hashlib
import io
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib
import xml.etree.ElementTree
import zipfile

import h5py
import numpy as np
import scipy.fft

HERE = pathlib.Path(__file__).resolve().parent
CERTIFICATE = 1e-8  # what every increment of a profile promises
SOLVED = 1e-10      # what the reference is solved to

# ---------------------------------------------------------------------------------------------------------- surfaces


def read_gwyddion_text(path):
    """Heights [m], rows as in the file, and the spacing (dx, dy) [m]."""
    lines = path.read_text(encoding="utf-8").splitlines()
    header = dict(re.findall(r"^# (\w[\w ]*): (.*)$", "\n".join(lines), re.MULTILINE))
    scale = {"m": 1.0, "mm": 1e-3, "µm": 1e-6, "nm": 1e-9}
    heights = np.loadtxt([line for line in lines if line and not line.startswith("#")]) * scale[header["Value units"]]
    extents = []
    for key in ("Width", "Height"):
        number, unit = header[key].split()
        extents.append(float(number) * scale[unit])
    return heights, (extents[0] / heights.shape[1], extents[1] / heights.shape[0])


def read_x3p(path):
    """Heights [m] and spacing (dx, dy) [m] of an ISO 25178-72 file with points in binary doubles."""
    with zipfile.ZipFile(path) as archive:
        root = xml.etree.ElementTree.fromstring(archive.read("main.xml"))
        nx, ny = (int(root.findtext(f".//MatrixDimension/Size{axis}")) for axis in "XY")
        data = archive.read(root.findtext(".//PointDataLink"))
        if hashlib.md5(data).hexdigest().upper() != root.findtext(".//MD5ChecksumPointData").upper():
            raise ValueError(f"{path}: the checksum of the points is wrong")
        if root.findtext(".//CZ/DataType") != "D" or root.findtext(".//CZ/AxisType") != "A":
            raise ValueError(f"{path}: expected absolute heights as doubles")
        heights = np.frombuffer(data, "<f8").reshape(ny, nx)
        return heights, tuple(float(root.findtext(f".//C{axis}/Increment")) for axis in "XY")


def without_plane(heights):
    """Heights less their least-squares plane."""
    j, i = (index - index.mean() for index in np.indices(heights.shape, dtype=float))
    columns = np.stack([np.ones(heights.size), i.ravel(), j.ravel()], axis=1)
    coefficients = np.linalg.lstsq(columns, heights.ravel(), rcond=None)[0]
    return heights - (columns @ coefficients).reshape(heights.shape)


def synthesised_gap(program, scene_file):
    """The undeformed gap as `program` makes it from the scene, solved for nothing but a light load."""
    text = re.sub(r"\[\[step\]\].*", "", scene_file.read_text(), flags=re.DOTALL)
    text += '[[step]]\nmean_pressure = 1e6\n[output]\nfields = ["undeformed_gap"]\n'
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / "scene.toml"
        scene.write_text(text)
        subprocess.run([program, "run", scene, "--out", pathlib.Path(folder) / "out", "--quiet"], check=True)
        with h5py.File(pathlib.Path(folder) / "out" / "fields.h5") as file:
            return file["step_0/increment_0/undeformed_gap"][()], tuple(file.attrs["spacing"][:2])


def places(scene):
    """x of the columns and y of the rows [m], from the grid's centre."""
    return ((np.arange(n) - (n - 1) / 2) * d for n, d in zip(scene["grid"]["nodes"], scene["grid"]["spacing"]))


def shape_gap(scene, surface):
    """Parabolic arcs: beyond the flat of a punch; beyond the straight part of a roller and across it."""
    if surface.get("profile", "parabolic") != "parabolic":
        raise ValueError("expected parabolic arcs")
    x, y = places(scene)
    if surface["shape"] == "flat_punch":
        beyond = np.maximum(np.hypot(x[None, :], y[:, None]) - surface["radius"], 0)
        return beyond**2 / (2 * surface["edge_radius"])
    beyond = np.maximum(np.abs(x) - surface["straight_length"] / 2, 0)
    return (beyond**2 / (2 * surface["crown_radius"]))[None, :] + (y**2 / (2 * surface["radius"]))[:, None]


def gap_of(program, scene_file, scene, surface):
    if surface["shape"] in ("flat_punch", "roller"):
        return shape_gap(scene, surface), scene["grid"]["spacing"]
    if surface["shape"] == "rough":
        return synthesised_gap(program, scene_file)
    path = scene_file.parent / surface["path"]
    heights, spacing = read_x3p(path) if path.suffix == ".x3p" else read_gwyddion_text(path)
    if surface.get("detrend") != "plane":
        raise ValueError(f"{scene_file}: expected detrend = \"plane\"")
    return -without_plane(heights), spacing


# ------------------------------------------------------------------------------------------------------ displacement


def love(nx, ny, dx, dy):
    """Displacement times E* at node (i, j) of a unit pressure on the cell around node (0, 0) [m]."""
    x = np.arange(nx, dtype=np.longdouble)[None, :] * np.longdouble(dx)
    y = np.arange(ny, dtype=np.longdouble)[:, None] * np.longdouble(dy)
    a, b = np.longdouble(dx) / 2, np.longdouble(dy) / 2

    def corner(x, y):
        return x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))

    total = corner(x + a, y + b) - corner(x - a, y + b) - corner(x + a, y - b) + corner(x - a, y - b)
    return (total / np.longdouble(np.pi)).astype(float)


def wave_numbers(nx, ny, dx, dy):
    return 2 * np.pi * np.hypot(np.fft.rfftfreq(nx, dx)[None, :], np.fft.fftfreq(ny, dy)[:, None])


def displacement_of_periodic(nx, ny, dx, dy):
    q = wave_numbers(nx, ny, dx, dy)
    q[0, 0] = np.inf
    spectrum = 2 / q
    return lambda p: scipy.fft.irfft2(scipy.fft.rfft2(p) * spectrum, (ny, nx))


def displacement_of_free(nx, ny, dx, dy):
    quarter = love(nx, ny, dx, dy)
    kernel = np.zeros((2 * ny, 2 * nx))
    kernel[:ny, :nx] = quarter
    kernel[ny + 1:, :nx] = quarter[:0:-1]
    kernel[:, nx + 1:] = kernel[:, nx - 1:0:-1]
    spectrum = scipy.fft.rfft2(kernel)
    return lambda p: scipy.fft.irfft2(scipy.fft.rfft2(p, (2 * ny, 2 * nx)) * spectrum, (2 * ny, 2 * nx))[:ny, :nx]


# ------------------------------------------------------------------------------------------------------------ solver


def polonsky_keer(displacement, gap, total, p, tolerance, most=20000):
    """Pressure p >= 0 with sum `total`, and approach, so that the deformed gap r >= 0 and p r = 0.

    Ends when the largest penetration and sum(p |r|) / sum(p), both relative to the largest displacement, are within
    `tolerance`.
    """
    p = p * (total / p.sum())
    direction = np.zeros_like(gap)
    previous, keep = 1.0, 0.0
    for iteration in range(most):
        u = displacement(p)
        g = gap + u
        contact = p > 0
        approach = g[contact].mean()
        r = g - approach
        largest = np.abs(u).max()
        error = max(-r.min(), (p * np.abs(r)).sum() / total, 0.0)
        if error <= tolerance * largest:
            return p, r, approach, largest, iteration, error / largest
        residual = np.where(contact, r, 0.0)
        square = (residual**2).sum()
        direction = np.where(contact, residual + keep * square / previous * direction, 0.0)
        previous = square
        answer = displacement(direction)
        answer -= answer[contact].mean()
        step = (residual * direction).sum() / (answer[contact] * direction[contact]).sum()
        p = np.maximum(p - step * direction, 0.0)
        overlapping = (p == 0) & (r < 0)
        keep = 0.0 if overlapping.any() else 1.0
        p[overlapping] -= step * r[overlapping]
        p *= total / p.sum()
    raise RuntimeError(f"no convergence in {most} iterations, error {error / largest:.1e}")


def newton_for_slopes(displacement, gap, total, p, place, centre, slopes, tolerance):
    """Slopes of the plane on the gap that bring the centre of the pressure to `centre`, and what polonsky_keer gives.

    place: (x, y) of all nodes [m]. Ends when the centre is met to a tenth of CERTIFICATE times half the grid. Returns
    slopes, d centre / d slopes, number of solutions, and the solution.
    """
    half = np.array([place[0].max(), place[1].max()])
    solutions = 0

    def solve(slopes, p):
        nonlocal solutions
        solutions += 1
        solution = polonsky_keer(displacement, gap + slopes[0] * place[0] + slopes[1] * place[1], total, p, tolerance)
        return solution, np.array([(solution[0] * axis).sum() for axis in place]) / total - centre

    solution, miss = solve(slopes, p)
    jacobian = np.empty((2, 2))
    for k in range(2):
        extent = np.abs(place[k][solution[0] > 0]).max()
        change = np.zeros(2)
        change[k] = 1e-4 * solution[3] / extent
        jacobian[:, k] = (solve(slopes + change, solution[0])[1] - miss) / change[k]
    while (np.abs(miss) > 0.1 * CERTIFICATE * half).any():
        change = np.linalg.solve(jacobian, -miss)
        slopes = slopes + change
        before = miss
        solution, miss = solve(slopes, solution[0])
        jacobian += np.outer(miss - before - jacobian @ change, change) / (change @ change)
        if solutions > 60:
            raise RuntimeError(f"no slopes: the centre of the pressure is {miss} m off")
    return slopes, jacobian, solutions, solution


# -------------------------------------------------------------------------------------------------------- references


def quantity(value, tolerance, source):
    return {"value": value, "tolerance": tolerance, "source": source}


def contact_modulus(scene):
    bodies = (scene["lower"], scene["lower"] if scene["upper"].get("same_as_lower") else scene["upper"])
    compliance = sum((1 - body["poissons_ratio"]**2) / body["youngs_modulus"] for body in bodies
                     if not body.get("rigid"))
    return 1 / compliance


def load_levels(scene, cell, nodes):
    """(step, increment, force [N]) of every increment; a step goes from the last one's load in equal parts."""
    last = 0.0
    for number, step in enumerate(scene["step"]):
        target = step["normal_force"] if "normal_force" in step else step["mean_pressure"] * cell * nodes
        count = step.get("increments", 1)
        for k in range(count):
            yield number, k, last + (target - last) * (k + 1) / count
        last = target


# Relative errors of the discretisation are at most these constants times h^2, h and h^2, h = spacing / contact radius: the
# area is counted in whole cells along the edge; the largest pressure is taken half a cell beside the apex, both ways, and
# as a cell's mean, where p = p0 (1 - r^2 / (2 a^2)); the approach feels second differences. The constants are twice the
# largest that the refinement in hertz_sphere/README.md shows.
HERTZ_APPROACH, HERTZ_AREA, HERTZ_PRESSURE = 0.12, 0.7, 0.45


def hertz(scene):
    """The closed form, with the tolerances of the scene's grid."""
    modulus, radius = contact_modulus(scene), scene["surface"][0]["radius"]
    nx, ny = scene["grid"]["nodes"]
    dx, dy = scene["grid"]["spacing"]
    x, y = places(scene)
    square = x[None, :]**2 + y[:, None]**2
    for step, increment, force in load_levels(scene, dx * dy, nx * ny):
        a = (3 * force * radius / (4 * modulus))**(1 / 3)
        approach = a**2 / radius
        pressure = 3 * force / (2 * math.pi * a**2)
        # Displacement outside the contact: Johnson, eq. 3.42a.
        r = np.sqrt(np.maximum(square, a**2))
        u = approach / (math.pi * a**2) * ((2 * a**2 - r**2) * np.arcsin(a / r) + a * np.sqrt(r**2 - a**2))
        gap = np.where(square > a**2, square / (2 * radius) + u - approach, 0.0)
        h = max(dx, dy) / a
        yield {"step": step, "increment": increment,
               "normal_force": quantity(force, CERTIFICATE * force, "load"),
               "approach": quantity(approach, HERTZ_APPROACH * h**2 * approach, "hertz"),
               "contact_area": quantity(math.pi * a**2, HERTZ_AREA * h * math.pi * a**2, "hertz"),
               "max_pressure": quantity(pressure, HERTZ_PRESSURE * h**2 * pressure, "hertz"),
               "mean_gap": quantity(gap.mean(), HERTZ_APPROACH * h**2 * approach, "hertz")}


HERTZ_SOURCES = {
    "load": "prescribed in the scene",
    "hertz": "H. Hertz, J. reine angew. Math. 92 (1882) 156-171; K. L. Johnson, Contact Mechanics (1985), eq. 4.22 to "
             "4.24, gap outside the contact from eq. 3.42a. Tolerance: order of the discretisation in h = spacing / "
             f"contact radius; relative to the value, approach {HERTZ_APPROACH} h^2 (mean gap as much in metres), contact "
             f"area {HERTZ_AREA} h, largest pressure {HERTZ_PRESSURE} h^2"}


def solved(scene, gap, spacing):
    """One increment after the other by Polonsky and Keer, each from the last one's pressure.

    Tolerances follow from the certificate: deformed gaps are uncertain by CERTIFICATE * u, u the largest displacement
    (slack 10 for approach and mean gap, which are averages over all of the contact). A pressure answers a gap at its own
    node through the stiffest mode of the grid, whose compliance per unit of E* is `least`; nodes that such a change can
    open or close decide the tolerance of the contact area. Slopes are uncertain by those gaps over the contact's half
    extent, and by what moments within CERTIFICATE (times force and half the grid) leave open. Where the pressure peaks
    is left out for bodies that tilt: their symmetry gives two or more nodes the same peak.
    """
    ny, nx = gap.shape
    dx, dy = spacing
    cell = dx * dy
    modulus = contact_modulus(scene)
    periodic = scene.get("grid", {}).get("boundary") == "periodic"
    displacement = (displacement_of_periodic if periodic else displacement_of_free)(nx, ny, dx, dy)
    q = wave_numbers(nx, ny, dx, dy)
    least = 2 / q.max()
    place = np.meshgrid((np.arange(nx) - (nx - 1) / 2) * dx, (np.arange(ny) - (ny - 1) / 2) * dy)
    half = np.array([nx * dx, ny * dy]) / 2
    p = np.ones_like(gap)
    slopes = np.zeros(2)
    for step, increment, force in load_levels(scene, cell, nx * ny):
        total = force / (modulus * cell)
        if "tilt" in scene["step"][step]:
            raise ValueError("expected eccentricities, not slopes")
        eccentricity = scene["step"][step].get("eccentricity")
        if eccentricity is None:
            p, r, approach, largest, iterations, error = polonsky_keer(displacement, gap, total, p, SOLVED)
        else:
            slopes, jacobian, solutions, solution = newton_for_slopes(
                displacement, gap, total, p, place, np.array(eccentricity), slopes, SOLVED)
            p, r, approach, largest, iterations, error = solution
            print(f"    slopes {slopes} from {solutions} solutions")
        source = "polonsky_keer" if eccentricity is None else "newton"
        contact = p > 0
        if periodic and contact.all():
            closed = force / (modulus * cell * nx * ny) - scipy.fft.irfft2(scipy.fft.rfft2(gap) * q / 2, gap.shape)
            print(f"    full contact: closed form differs by {np.abs(p - closed).max() / p.max():.1e} in pressure")
            p, r, approach, source = closed, np.zeros_like(gap), gap.mean(), "full_contact"
        slip = CERTIFICATE * largest
        unsure = int((contact & (p * least < 10 * slip)).sum() + (~contact & (r < 10 * slip)).sum())
        nodes = int(contact.sum())
        at = np.unravel_index(p.argmax(), p.shape)
        print(f"    step {step} increment {increment}: {iterations} iterations, error {error:.1e}, {nodes} nodes "
              f"(unsure {unsure}), approach {approach:.12g}, largest pressure {p.max() * modulus:.10g}", flush=True)
        turning = {"max_pressure_at": quantity([(at[1] - (nx - 1) / 2) * dx, (at[0] - (ny - 1) / 2) * dy],
                                               1e-3 * min(dx, dy), source)}
        if eccentricity is not None:
            extents = np.array([np.abs(axis[contact]).max() for axis in place])
            open_moments = np.abs(np.linalg.inv(jacobian)) @ (CERTIFICATE * half)
            turning = {"tilt": quantity(list(slopes), list(10 * slip / extents + open_moments), source),
                       "centre_of_force": quantity(list(eccentricity), list(CERTIFICATE * half), "load")}
        yield {"step": step, "increment": increment,
               "normal_force": quantity(force, CERTIFICATE * force, "load"),
               "approach": quantity(approach, 10 * slip, source),
               "first_touch": quantity(gap.min(), 1e-12 * np.abs(gap).max(), "surface"),
               "contact_area": quantity(nodes * cell, (unsure + 1e-9) * cell, source),
               "contact_nodes": quantity(nodes, unsure, source),
               "max_pressure": quantity(p.max() * modulus, slip / least * modulus, source),
               "mean_gap": quantity(r.mean(), 10 * slip, source), **turning}


SOLVED_SOURCES = {
    "load": "prescribed in the scene",
    "polonsky_keer": "conjugate gradients of Polonsky and Keer (Wear 231, 1999, 206-219) in numpy with coefficients of "
                     f"their own, profiles/reference.py, solved to {SOLVED:g}. Tolerance: what a certificate of "
                     f"{CERTIFICATE:g} leaves open, derived there"}

NEWTON = ("as polonsky_keer, with Newton's method around it for the slopes that put the force where the scene says, its "
          "Jacobian by finite differences and Broyden's formula. Tolerance: what a certificate of "
          f"{CERTIFICATE:g} leaves open, derived there")

SURFACE_SOURCES = {
    "flat_punch": "smallest value of the shape's formula at the nodes; tolerance: rounding",
    "roller": "smallest value of the shape's formula at the nodes; tolerance: rounding",
    "file": "the measured file, read and levelled by profiles/reference.py; tolerance: rounding",
    "rough": "the undeformed gap of the synthesised surface as brinell writes it; tolerance: rounding"}

FULL_CONTACT = ("full contact has a closed form: p = mean pressure - E* |q| gap(q) / 2 (Johnson, Contact Mechanics, 1985, "
                "section 13.2), approach = mean of the undeformed gap. Tolerance as for polonsky_keer")


def reference(program, folder):
    scene_file = folder / "scene.toml"
    scene = tomllib.loads(scene_file.read_text())
    surface = scene["surface"][0]
    if len(scene["surface"]) != 1:
        raise ValueError(f"{scene_file}: expected one [[surface]]")
    if surface["shape"] == "sphere":
        sources, increments = HERTZ_SOURCES, list(hertz(scene))
    else:
        increments = list(solved(scene, *gap_of(program, scene_file, scene, surface)))
        sources = {**SOLVED_SOURCES, "surface": SURFACE_SOURCES[surface["shape"]]}
        if any(i["approach"]["source"] == "full_contact" for i in increments):
            sources["full_contact"] = FULL_CONTACT
        if any(i["approach"]["source"] == "newton" for i in increments):
            del sources["polonsky_keer"]
            sources["newton"] = NEWTON.replace("as polonsky_keer", SOLVED_SOURCES["polonsky_keer"].split(". ")[0])
    return {"title": scene["title"], "certificate": CERTIFICATE, "sources": sources, "increments": increments}


def as_text(values):
    """JSON with a line for each quantity."""
    out = io.StringIO()
    out.write("{\n")
    for key in ("title", "certificate", "sources"):
        out.write(f" {json.dumps(key)}: {json.dumps(values[key], indent=1).replace(chr(10), chr(10) + ' ')},\n")
    blocks = []
    for increment in values["increments"]:
        lines = [f"   {json.dumps(key)}: {json.dumps(value)}" for key, value in increment.items()]
        blocks.append("  {\n" + ",\n".join(lines) + "\n  }")
    out.write(' "increments": [\n' + ",\n".join(blocks) + "\n ]\n}\n")
    return out.getvalue()


def main(arguments):
    if len(arguments) < 2:
        sys.exit("usage: reference.py PROGRAM NAME...")
    for name in arguments[1:]:
        print(f"{name}:", flush=True)
        (HERE / name / "reference.json").write_text(as_text(reference(arguments[0], HERE / name)))


if __name__ == "__main__":
    main(sys.argv[1:])
