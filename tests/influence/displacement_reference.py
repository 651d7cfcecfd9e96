#!/usr/bin/env python3
"""Writes displacement_reference.inl: K(i, j) = (1/pi) * integral of 1/r over the cell dx x dy, to 50 digits.

Love's closed form in 150-digit arithmetic, so that its cancellation (up to 25 digits here) does not matter.
Needs python3-mpmath. Usage: displacement_reference.py > displacement_reference.inl
"""
import random

from mpmath import asinh, fabs, mp, mpf, nstr, pi

mp.dps = 150


def edge(c, upper, lower):
    """c * integral of dt / sqrt(c^2 + t^2) from lower to upper."""
    return mpf(0) if c == 0 else c * (asinh(upper / fabs(c)) - asinh(lower / fabs(c)))


def coefficient(i, j, dx, dy):
    dx, dy = mpf(dx), mpf(dy)
    a, b, x, y = dx / 2, dy / 2, i * dx, j * dy
    total = (edge(x + a, y + b, y - b) - edge(x - a, y + b, y - b)
             + edge(y + b, x + a, x - a) - edge(y - b, x + a, x - a))
    return total / pi


def offsets(generator):
    near = [(0, 0), (1, 0), (0, 1), (1, 1), (3, 0), (0, 3), (3, 3), (4, 0), (0, 4), (4, 3), (3, 4), (7, 5), (5, 8)]
    far = []
    for exponent in range(1, 7):
        d = 10**exponent
        far += [(d, 0), (0, d), (d, d), (int(d * 0.37), d)]
        far.append((generator.randint(0, d), generator.randint(0, d)))
    return near + far


def main():
    generator = random.Random(20240)
    print("// Written by displacement_reference.py: {i, j, dx, dy, K(i, j)}.")
    for dx, dy in [(1.0, 1.0), (0.2e-6, 0.2e-6), (1e-6, 0.7e-6), (0.3, 1.0), (10.0, 1.0), (2e-7, 2e-6),
                   (1e-3, 1.0), (5e-4, 5e-7)]:
        for i, j in offsets(generator):
            print(f"{{{i}, {j}, {dx!r}, {dy!r}, {nstr(coefficient(i, j, dx, dy), 50)}L}},")


main()
