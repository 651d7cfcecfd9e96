#!/usr/bin/env python3
"""Writes stress_reference.inl: the stress below a cell dx x dy under unit pressure and unit shears.

The point forces of Boussinesq and Cerruti (K. L. Johnson, Contact Mechanics, 1985, eqs. 3.19 and 3.76) integrated
over the cell in 25-digit arithmetic: panels are halved until each is small against its distance from the field
point, then a 16 x 16 Gauss-Legendre rule; about 18 digits are right. Needs python3-mpmath and a few minutes.
Usage: stress_reference.py > stress_reference.inl
"""
from mpmath import cos, hypot, mp, mpf, nstr, pi, sqrt

mp.dps = 25
COUNT = 16


def rule():
    nodes = []
    for k in range(COUNT):
        t = -cos(pi * (k + mpf(3) / 4) / (COUNT + mpf(1) / 2))
        for _ in range(8):  # Newton
            previous, value = mpf(1), t
            for n in range(2, COUNT + 1):
                previous, value = value, ((2 * n - 1) * t * value - (n - 1) * previous) / n
            slope = COUNT * (t * value - previous) / (t * t - 1)
            t -= value / slope
        nodes.append((t, 2 / ((1 - t * t) * slope**2)))
    return nodes


RULE = rule()


def normal(x, y, z, nu):
    rho = sqrt(x * x + y * y + z * z)
    s, m, r2 = rho + z, 1 - 2 * nu, rho * rho
    r3, r5 = rho * r2, rho * r2 * r2
    t, w = 1 / (rho * s), 1 / (r3 * s) + 1 / (r2 * s * s)
    even = -2 * nu * z / r3
    return [even - z * (3 * x * x / r5 - 1 / r3) - m * (t - x * x * w),
            even - z * (3 * y * y / r5 - 1 / r3) - m * (t - y * y * w),
            -3 * z**3 / r5, -3 * y * z * z / r5, -3 * x * z * z / r5, -3 * x * y * z / r5 + m * x * y * w]


def tangential(x, y, z, nu):
    rho = sqrt(x * x + y * y + z * z)
    s, m, r2 = rho + z, 1 - 2 * nu, rho * rho
    r3, r5 = rho * r2, rho * r2 * r2
    t, u = 1 / (rho * s * s), 1 / (r3 * s * s) + 2 / (r2 * s**3)
    return [-3 * x**3 / r5 + m * (x / r3 - 3 * x * t + x**3 * u),
            -3 * x * y * y / r5 + m * (x / r3 - x * t + x * y * y * u),
            -3 * x * z * z / r5, -3 * x * y * z / r5, -3 * x * x * z / r5,
            -3 * x * x * y / r5 + m * (-y * t + x * x * y * u)]


def integrate(force, x, y, z, nu, left, right, low, high):
    width, height = right - left, high - low
    away = hypot(hypot(max(left - x, x - right, mpf(0)), max(low - y, y - high, mpf(0))), z)
    if max(width, height) > away * mpf("0.8"):
        if width >= height:
            middle = (left + right) / 2
            parts = [(left, middle, low, high), (middle, right, low, high)]
        else:
            middle = (low + high) / 2
            parts = [(left, right, low, middle), (left, right, middle, high)]
        halves = [integrate(force, x, y, z, nu, *part) for part in parts]
        return [first + second for first, second in zip(*halves)]
    total = [mpf(0)] * 6
    for t, wt in RULE:
        for u, wu in RULE:
            point = force(x - (left + right + width * t) / 2, y - (low + high + height * u) / 2, z, nu)
            total = [value + wt * wu * part for value, part in zip(total, point)]
    return [value * width * height / 4 for value in total]


def stress(traction, x, y, z, dx, dy, nu):
    a, b = dx / 2, dy / 2
    if traction == 2:
        turned = stress(1, y, x, z, dy, dx, nu)
        return [turned[k] for k in (1, 0, 2, 4, 3, 5)]
    force = normal if traction == 0 else tangential
    return [value / (2 * pi) for value in integrate(force, x, y, z, nu, -a, a, -b, b)]


POINTS = [  # i, j, depth, dx, dy, nu
    (0, 0, 0.01, 1.0, 1.0, 0.3), (1, 0, 0.01, 1.0, 1.0, 0.0), (2, 1, 0.05, 1.0, 1.0, 0.4999),
    (0, 0, 0.5, 1.0, 1.0, 0.25), (3, 2, 0.5, 1.0, 1.0, 0.3), (4, 4, 2.0, 1.0, 1.0, 0.3),
    (0, 7, 1.0, 1.0, 1.0, 0.4999), (20, 11, 3.0, 1.0, 1.0, 0.3), (300, 1, 0.01, 1.0, 1.0, 0.3),
    (1000, 700, 1000.0, 1.0, 1.0, 0.1), (1, 2, 0.2e-6, 0.2e-6, 0.3e-6, 0.3), (5, 1, 0.25, 0.125, 1.0, 0.3),
    (2, 30, 0.1, 1.0, 0.125, 0.0), (-3, 2, 0.5, 1.0, 1.0, 0.3), (3, -2, 0.5, 1.0, 1.0, 0.3),
]


def main():
    print("// Written by stress_reference.py: {traction, i, j, depth, dx, dy, nu, {xx, yy, zz, yz, xz, xy}}.")
    for i, j, depth, dx, dy, nu in POINTS:
        for traction in range(3):
            values = stress(traction, i * mpf(dx), j * mpf(dy), mpf(depth), mpf(dx), mpf(dy), mpf(nu))
            components = ", ".join(nstr(value, 20) for value in values)
            print(f"{{{traction}, {i}, {j}, {depth!r}, {dx!r}, {dy!r}, {nu!r}, {{{components}}}}},")


main()
