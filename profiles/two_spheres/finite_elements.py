#!/usr/bin/env python3
"""The contact of two_spheres by axisymmetric finite elements, to tell which figures are right: needs numpy and scipy.

    finite_elements.py CELL FORCE INCREMENTS [one]      cell size [m] near the contact, force [N]

Two identical spheres touch along their plane of symmetry: each is a half-space under a rigid paraboloid r²/(2 R) with
the radius R of the sphere. With `one` the other sphere stays elastic: it has the same mesh, mirrored, so that nodes meet
nodes, and is condensed to the compliance of those that may touch; with w the normal displacement of the other body's
nodes, w = compliance · forces, contact is u + w = approach - r²/R at equal forces without friction. When FORCE is
reached the bodies are taken apart, and the residual stress on the axis is printed.

Four-node elements with the mean dilatation in place of the local one (T. J. R. Hughes, Int. J. Numer. Meth. Engng 15,
1980, 1413-1418), small strain, von Mises stress and Swift's law, backward Euler with the consistent tangent (J. C. Simo &
R. L. Taylor, Comput. Meth. Appl. Mech. Engng 48, 1985, 101-118), nodes in contact found by their reactions. Nothing is
shared with brinell. z points into the body; Voigt order rr, zz, tt, rz.
"""

import sys

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

RADIUS, YOUNG, POISSON = 15e-3, 210e9, 0.3
B, C, N = 945e6, 20.0, 0.121
SHEAR = YOUNG / (2 * (1 + POISSON))
BULK = YOUNG / (3 * (1 - 2 * POISSON))
ONE = np.array([1.0, 1.0, 1.0, 0.0])
DEVIATOR = np.diag([1.0, 1.0, 1.0, 0.5]) - np.outer(ONE, ONE) / 3


def yield_stress(p):
    return B * (C + 1e6 * p) ** N, B * N * 1e6 * (C + 1e6 * p) ** (N - 1)


def graded(cell, fine, far):
    """Coordinates with cells of one size as far as `fine`, growing by 1.15 up to `far`."""
    x = list(np.arange(0, fine + cell / 2, cell))
    while x[-1] < far:
        x.append(x[-1] + 1.15 * (x[-1] - x[-2]))
    return np.array(x)


class Mesh:
    def __init__(self, cell, contact_radius):
        x = graded(cell, 1.5 * contact_radius, 45 * contact_radius)
        z = graded(cell, 2.2 * contact_radius, 45 * contact_radius)
        n, m = len(x), len(z)
        self.r, self.z = (a.ravel() for a in np.meshgrid(x, z))
        first = (np.arange(m - 1)[:, None] * n + np.arange(n - 1)).ravel()
        self.elements = np.stack([first, first + 1, first + n + 1, first + n], 1)
        self.surface = np.arange(n)
        self.may_touch = int((x <= 1.5 * contact_radius).sum())
        self.fixed = np.concatenate([2 * np.arange(0, n * m, n), 2 * np.arange(n * (m - 1), n * m) + 1])
        self.shapes()

    def shapes(self):
        r, z = self.r[self.elements], self.z[self.elements]
        strain, weight, radius = [], [], []
        g = 1 / np.sqrt(3)
        sx, sz = np.array([-1, 1, 1, -1]), np.array([-1, -1, 1, 1])
        for a, b in ((-g, -g), (g, -g), (g, g), (-g, g)):
            shape = (1 + sx * a) * (1 + sz * b) / 4
            da, db = sx * (1 + sz * b) / 4, sz * (1 + sx * a) / 4
            ra, rb, za, zb = r @ da, r @ db, z @ da, z @ db
            det = ra * zb - rb * za
            dr = (zb[:, None] * da - za[:, None] * db) / det[:, None]
            dz = (ra[:, None] * db - rb[:, None] * da) / det[:, None]
            at = r @ shape
            matrix = np.zeros((len(r), 4, 8))
            matrix[:, 0, 0::2], matrix[:, 1, 1::2], matrix[:, 2, 0::2] = dr, dz, shape / at[:, None]
            matrix[:, 3, 0::2], matrix[:, 3, 1::2] = dz, dr
            strain.append(matrix)
            weight.append(2 * np.pi * at * det)
            radius.append(at)
        self.strain, self.weight = np.stack(strain, 1), np.stack(weight, 1)
        self.at = np.stack([np.stack(radius, 1), np.stack([z @ ((1 + sx * a) * (1 + sz * b) / 4) for a, b in
                                                           ((-g, -g), (g, -g), (g, g), (-g, g))], 1)])
        dilatation = self.strain[:, :, :3].sum(2)
        mean = (dilatation * self.weight[:, :, None]).sum(1) / self.weight.sum(1)[:, None]
        self.strain[:, :, :3] += ((mean[:, None] - dilatation) / 3)[:, :, None]
        dofs = np.stack([2 * self.elements, 2 * self.elements + 1], 2).reshape(len(r), 8)
        self.dofs = dofs
        self.rows, self.columns = np.repeat(dofs, 8, 1).ravel(), np.tile(dofs, (1, 8)).ravel()
        share = np.zeros(len(self.surface))  # area that belongs to each node of the surface
        x = self.r[self.surface]
        left, right = x[:-1], x[1:]
        share[:-1] += 2 * np.pi * (right - left) * (2 * left + right) / 6
        share[1:] += 2 * np.pi * (right - left) * (left + 2 * right) / 6
        self.share = share


def constitutive(strain, plastic, p):
    """Stress, consistent tangent, plastic strain and p at the end of the increment."""
    elastic = strain - plastic
    trace = elastic[..., :3].sum(-1)
    s = 2 * SHEAR * (elastic - trace[..., None] / 3 * ONE) * np.array([1, 1, 1, 0.5])
    norm = np.sqrt((s[..., :3] ** 2).sum(-1) + 2 * s[..., 3] ** 2)
    q = np.sqrt(1.5) * norm
    d = np.zeros_like(p)
    flows = q > yield_stress(p)[0]
    for _ in range(60):  # monotone from 0, since the law is concave
        sigma, slope = yield_stress(p[flows] + d[flows])
        step = (q[flows] - 3 * SHEAR * d[flows] - sigma) / (3 * SHEAR + slope)
        d[flows] += step
        if not step.size or np.abs(step).max() < 1e-15:
            break
    safe = np.where(norm > 0, norm, 1)
    direction = s / safe[..., None]
    slope = yield_stress(p + d)[1]
    ratio = np.where(flows, d / np.where(q > 0, q, 1), 0)
    stress = BULK * trace[..., None] * ONE + s * (1 - 3 * SHEAR * ratio)[..., None]
    tangent = (BULK * np.outer(ONE, ONE) + 2 * SHEAR * (1 - 3 * SHEAR * ratio)[..., None, None] * DEVIATOR)
    factor = np.where(flows, 6 * SHEAR**2 * (ratio - 1 / (3 * SHEAR + slope)), 0)
    tangent = tangent + factor[..., None, None] * direction[..., :, None] * direction[..., None, :]
    flow = d[..., None] * np.sqrt(1.5) * direction * np.array([1, 1, 1, 2])
    return stress, tangent, plastic + flow, p + d


def stiffness(mesh, tangent):
    size = 2 * len(mesh.r)
    blocks = np.einsum("egij,egik,egkl,eg->ejl", mesh.strain, tangent, mesh.strain, mesh.weight, optimize=True)
    return scipy.sparse.csc_matrix((blocks.ravel(), (mesh.rows, mesh.columns)), (size, size))


def elastic_compliance(mesh):
    """Normal displacement of the surface nodes that may touch, of an elastic body, for unit forces on them."""
    elastic = BULK * np.outer(ONE, ONE) + 2 * SHEAR * DEVIATOR
    matrix = stiffness(mesh, np.broadcast_to(elastic, mesh.strain.shape[:2] + (4, 4)))
    free = np.setdiff1d(np.arange(matrix.shape[0]), mesh.fixed)
    at = np.searchsorted(free, 2 * mesh.surface[:mesh.may_touch] + 1)
    loads = np.zeros((len(free), len(at)))
    loads[at, np.arange(len(at))] = 1
    return scipy.sparse.linalg.splu(matrix[free][:, free]).solve(loads)[at]


def solve_against_elastic(mesh, compliance, approach, u, plastic, p, contact):
    """As solve(), approach that of both bodies, the other one given by its compliance."""
    size = 2 * len(mesh.r)
    touching = mesh.surface[:mesh.may_touch]
    target = approach - mesh.r[touching] ** 2 / RADIUS
    vertical = 2 * touching + 1
    free = np.setdiff1d(np.arange(size), mesh.fixed)
    for iteration in range(80):
        strain = np.einsum("egij,ej->egi", mesh.strain, u[mesh.dofs])
        stress, tangent, new_plastic, new_p = constitutive(strain, plastic, p)
        force = np.zeros(size)
        np.add.at(force, mesh.dofs, np.einsum("egij,egi,eg->ej", mesh.strain, stress, mesh.weight))
        before = contact.copy()
        held = np.flatnonzero(contact)
        spring = np.linalg.inv(compliance[np.ix_(held, held)])
        pressing = np.zeros(len(touching))
        pressing[held] = spring @ (target - u[vertical])[held]
        if iteration > 0:
            overlap = target - u[vertical] - compliance @ pressing
            contact = (contact & (pressing > 0)) | (~contact & (overlap > 0))
        residual = force.copy()
        residual[vertical] -= pressing
        if (iteration > 1 and (contact == before).all() and
                np.abs(residual[free]).max() < 1e-9 * max(np.abs(force).max(), 1e-30)):
            pressure = np.zeros(len(mesh.surface))
            pressure[:mesh.may_touch] = pressing / mesh.share[:mesh.may_touch]
            everywhere = np.zeros(len(mesh.surface), bool)
            everywhere[:mesh.may_touch] = contact
            return u, new_plastic, new_p, everywhere, pressure, stress
        held = np.flatnonzero(contact)
        spring = np.linalg.inv(compliance[np.ix_(held, held)])
        residual = force.copy()
        residual[vertical[held]] -= spring @ (target - u[vertical])[held]
        rows, columns = np.meshgrid(vertical[held], vertical[held], indexing="ij")
        matrix = stiffness(mesh, tangent) + scipy.sparse.csc_matrix(
            (spring.ravel(), (rows.ravel(), columns.ravel())), (size, size))
        step = np.zeros(size)
        step[free] = scipy.sparse.linalg.spsolve(matrix[free][:, free], -residual[free])
        u = u + step
    raise RuntimeError("no equilibrium")


def solve(mesh, approach, u, plastic, p, contact):
    """One increment of approach; returns displacements, state, nodes in contact, and the pressure of the nodes."""
    size = 2 * len(mesh.r)
    target = approach - mesh.r[mesh.surface] ** 2 / (2 * RADIUS)
    vertical = 2 * mesh.surface + 1
    for iteration in range(80):
        strain = np.einsum("egij,ej->egi", mesh.strain, u[mesh.dofs])
        stress, tangent, new_plastic, new_p = constitutive(strain, plastic, p)
        force = np.zeros(size)
        np.add.at(force, mesh.dofs, np.einsum("egij,egi,eg->ej", mesh.strain, stress, mesh.weight))
        pressure = force[vertical] / mesh.share
        before = contact.copy()
        if iteration > 0:
            contact = (contact & (pressure > 0)) | (~contact & (u[vertical] < target))
        held = np.concatenate([mesh.fixed, vertical[contact]])
        value = np.zeros(size)
        value[vertical[contact]] = target[contact] - u[vertical[contact]]
        free = np.ones(size, bool)
        free[held] = False
        residual = np.abs(force[free]).max() / max(np.abs(force).max(), 1e-30)
        if iteration > 1 and (contact == before).all() and residual < 1e-9 and np.abs(value).max() < 1e-15:
            return u, new_plastic, new_p, contact, pressure, stress
        matrix = stiffness(mesh, tangent)
        right = -(force + matrix @ value)
        step = value.copy()
        step[free] = scipy.sparse.linalg.spsolve(matrix[free][:, free], right[free])
        u = u + step
    raise RuntimeError("no equilibrium")


def print_residual(mesh, stress, hertz_pressure, hertz_radius):
    """Hydrostatic stress in the column of points next to the axis: its extreme, and its largest above and below."""
    column = mesh.at[0] < 1.01 * mesh.at[0].min()
    depth, mean = mesh.at[1][column], stress[column][:, :3].mean(-1) / hertz_pressure
    mean, depth = mean[np.argsort(depth)], np.sort(depth) / hertz_radius
    mean, depth = (mean[0::2] + mean[1::2]) / 2, (depth[0::2] + depth[1::2]) / 2  # of elements: points alternate
    least = mean.argmin()
    above, below = mean[:least].argmax(), least + mean[least:].argmax()
    for name, at in (("compressive", least), ("tensile above", above), ("tensile below", below)):
        print(f"residual hydrostatic stress, {name}: {mean[at]:.4f} of p_H at z/a = {depth[at]:.3f}")


def main(cell, force, increments, one_elastic):
    modulus = YOUNG / (1 - POISSON**2)
    contact_radius = (3 * force * RADIUS / (4 * modulus)) ** (1 / 3)
    mesh = Mesh(cell, contact_radius)
    compliance = elastic_compliance(mesh) if one_elastic else None
    points = mesh.strain.shape[:2]
    u, plastic, p = np.zeros(2 * len(mesh.r)), np.zeros(points + (4,)), np.zeros(points)
    contact = mesh.r[mesh.surface] < 0.1 * contact_radius
    last = contact_radius**2 / RADIUS
    print("force [N]   largest pressure [GPa]   equivalent plastic strain   at r, z [um]")
    for n in range(1, 10 * increments):
        approach = last * (n / increments) ** 0.8
        if one_elastic:
            u, plastic, p, contact, pressure, _ = solve_against_elastic(
                mesh, compliance, 2 * approach, u, plastic, p, contact[:mesh.may_touch])
        else:
            u, plastic, p, contact, pressure, _ = solve(mesh, approach, u, plastic, p, contact)
        at = np.unravel_index(p.argmax(), p.shape)
        total = (pressure * mesh.share)[contact].sum()
        centre = np.polyfit(mesh.r[mesh.surface[1:6]] ** 2, pressure[1:6], 1)[1]  # single nodes alternate a little
        print(f"{total:10.2f} {centre / 1e9:10.4f} {p.max():12.6f}   "
              f"{mesh.at[0][at] * 1e6:.1f} {mesh.at[1][at] * 1e6:.1f}", flush=True)
        if total > force:
            break
    apart = np.zeros(len(mesh.surface), bool)
    _, _, after, _, _, stress = solve(mesh, -1.0, u, plastic, p, apart)
    hertz_radius = (3 * total * RADIUS / (4 * modulus)) ** (1 / 3)
    print(f"largest increase of plastic strain on parting: {(after - p).max():.1e}")
    print_residual(mesh, stress, 1.5 * total / (np.pi * hertz_radius**2), hertz_radius)


if __name__ == "__main__":
    main(float(sys.argv[1]), float(sys.argv[2]), int(sys.argv[3]), "one" in sys.argv[4:])
