"""Bending frequencies of an annular plate, bore clamped, outside free: Kirchhoff's and Mindlin's exact solutions.

Prints the table that crates/fe/tests/verification/annular_plate.rs holds. Both theories separate in polar coordinates into Bessel
functions; a frequency is a zero of the determinant of the six (four) boundary conditions.
Mindlin (1951, kappa^2 = 5/6): w = w1 + w2, psi_r = (s1 - 1) dw1/dr + (s2 - 1) dw2/dr + n w3 / r,
psi_t = -n/r ((s1 - 1) w1 + (s2 - 1) w2) - dw3/dr, each w_j a combination of two Bessel functions of order n.
Kirchhoff: Leissa, Vibration of Plates, NASA SP-160 (1969), section 2.2.
"""

import numpy as np
from scipy.optimize import brentq
from scipy.special import ivp, jvp, kvp, yvp

INNER, OUTER, YOUNG, POISSON, DENSITY = 0.03, 0.1, 210e9, 0.3, 7800.0
SHEAR_FACTOR = 5.0 / 6.0


def pair(n, square, r):
    """Value and first two derivatives of the two solutions of order n with wave number squared `square`."""
    k = np.sqrt(abs(square))
    functions = (jvp, yvp) if square > 0.0 else (ivp, kvp)
    # Scaled by the value on the bore, so that the determinant keeps of one size.
    scale = [abs(f(n, k * INNER, 0)) for f in functions]
    return [[f(n, k * r, d) * k**d / s for d in range(3)] for f, s in zip(functions, scale)]


def mindlin(n, omega, h):
    d = YOUNG * h**3 / (12.0 * (1.0 - POISSON**2))
    g = SHEAR_FACTOR * h * YOUNG / (2.0 * (1.0 + POISSON))
    rotary, shear, fourth = h * h / 12.0, d / g, DENSITY * h * omega**2 / d
    root = np.sqrt((rotary - shear) ** 2 + 4.0 / fourth)
    squares = [0.5 * fourth * (rotary + shear + sign * root) for sign in (1.0, -1.0)]
    base = rotary * fourth - 1.0 / shear
    sigma = [squares[1] / base, squares[0] / base]
    squares.append(2.0 * base / (1.0 - POISSON))
    rows = []
    for r, free in ((INNER, False), (OUTER, True)):
        columns = []
        for j in range(3):
            for f, f1, f2 in pair(n, squares[j], r):
                if j < 2:
                    c = sigma[j] - 1.0
                    w, w1 = f, f1
                    pr, pr1 = c * f1, c * f2
                    pt, pt1 = -n / r * c * f, -n * c * (f1 / r - f / r**2)
                else:
                    w = w1 = 0.0
                    pr, pr1 = n / r * f, n * (f1 / r - f / r**2)
                    pt, pt1 = -f1, -f2
                # w, psi_r ~ cos(n t), psi_t ~ sin(n t)
                if free:
                    columns.append([
                        r * (pr1 + POISSON / r * (pr + n * pt)),
                        r * ((-n * pr - pt) / r + pt1),
                        (pr + w1),
                    ])
                else:
                    columns.append([w / r, pr, pt])
        rows.append(np.array(columns).T)
    matrix = np.vstack(rows)
    if n == 0:  # w3 alone is the torsion of the plate's fibres and does not couple
        matrix = matrix[np.ix_([0, 1, 3, 5], [0, 1, 2, 3])]
    return np.linalg.slogdet(matrix / np.linalg.norm(matrix, axis=0))


def kirchhoff(n, omega, h):
    d = YOUNG * h**3 / (12.0 * (1.0 - POISSON**2))
    square = np.sqrt(DENSITY * h * omega**2 / d)
    columns = []
    for s in (square, -square):
        inner, outer = pair(n, s, INNER), pair(n, s, OUTER)
        r = OUTER
        for (f, f1, _), (g, g1, g2) in zip(inner, outer):
            moment = g2 + POISSON * (g1 / r - n * n * g / r**2)
            # Laplacian of w is -s w.
            force = -s * g1 - (1.0 - POISSON) * n * n / r**2 * (g1 - g / r)
            columns.append([f, f1 * r, moment * r**2, force * r**3])
    matrix = np.array(columns).T
    return np.linalg.slogdet(matrix / np.linalg.norm(matrix, axis=0))


def lowest(theory, n, h):
    """Lowest frequency (Hz): the first change of sign of the determinant."""
    value = lambda hz: np.prod(theory(n, 2.0 * np.pi * hz, h)[0])
    grid = np.linspace(20.0, 6000.0, 3000) * h / 2e-3
    signs = np.array([value(hz) for hz in grid])
    first = np.flatnonzero(signs[:-1] * signs[1:] < 0.0)[0]
    sharp = lambda hz: (lambda s: s[0] * np.exp(s[1]))(theory(n, 2.0 * np.pi * hz, h))
    return brentq(sharp, grid[first], grid[first + 1], xtol=1e-9)


if __name__ == "__main__":
    for h in (2e-3, 1e-3):
        for n in range(5):
            thin, thick = lowest(kirchhoff, n, h), lowest(mindlin, n, h)
            factor = 2.0 * np.pi * thin * OUTER**2 * np.sqrt(12.0 * DENSITY * (1.0 - POISSON**2) / YOUNG) / h
            print(f"h {h * 1e3} mm, n {n}: Kirchhoff {thin:.4f} Hz (lambda^2 {factor:.4f}), Mindlin {thick:.4f} Hz")
