"""Computes the reference positions of Andrews' squeezing mechanism at t = 0.03 s, for crates/dynamics/tests/problems/andrews.rs.

    python andrews.py

Independent of the Rust code: seven relative angles, Lagrange's equations with six loop equations, reduced to index 1 by
differentiation and integrated by an explicit Runge-Kutta scheme of the eighth order. Equations from positions by automatic
differentiation with complex steps, so nothing but the geometry is typed in.

Data: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, section VII.7.
"""

import numpy as np
from scipy.integrate import solve_ivp

XA, YA, XB, YB, XC, YC = -0.06934, -0.00227, -0.03635, 0.03273, 0.014, 0.072
RR, RA, D, DA, SS, SA, SB, SC, SD = 7e-3, 92e-5, 28e-3, 115e-4, 35e-3, 1874e-5, 1043e-5, 18e-3, 2e-2
E, EA, ZT, TA, TB, ZF, FA, U, UA, UB = 2e-2, 1421e-5, 4e-2, 2308e-5, 916e-5, 2e-2, 1421e-5, 4e-2, 1228e-5, 449e-5
MASS = np.array([0.04325, 0.00365, 0.02373, 0.00706, 0.07050, 0.00706, 0.05498])
INERTIA = np.array([2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5])
C0, L0, MOMENT = 4530.0, 7785e-5, 33e-3
START = np.array([-0.0617138900142764496, 0.0, 0.455279819163070380, 0.222668390165885885, 0.487364979543842550,
                  -0.222668390165885885, 1.23054744454982120])
PUBLISHED = np.array([0.1581077119629904e2, -0.1575637105984298e2, 0.4082224013073101e-1, -0.5347301163226948,
                      0.5244099658805304, 0.5347301163226948, 0.1048080741042263e1])
STEP = 1e-30


def turned(angle, x, y):
    return np.array([np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y])


def absolute(q):
    b, t, g, p, d, o, e = q
    return np.array([b, b + t, g, p + d, d, o + e, e])


def centers(q):
    k = absolute(q)
    a, b = np.array([XA, YA]), np.array([XB, YB])
    crank = turned(k[0], RR, 0)
    return np.array([turned(k[0], RA, 0), crank + turned(k[1], -DA, 0), b + turned(k[2], SB, -SA),
                     a + turned(k[4], ZT, 0) + turned(k[3], 0, -(E - EA)), a + turned(k[4], TB, TA),
                     a + turned(k[6], 0, -U) + turned(k[5], ZF - FA, 0), a + turned(k[6], UB, -UA)])


def loops(q):
    k = absolute(q)
    a, b = np.array([XA, YA]), np.array([XB, YB])
    p = turned(k[0], RR, 0) + turned(k[1], -D, 0)
    return np.concatenate([p - b - turned(k[2], 0, -SS), p - a - turned(k[4], ZT, 0) - turned(k[3], 0, -E),
                           p - a - turned(k[6], 0, -U) - turned(k[5], ZF, 0)])


def potential(q):
    spring = turned(q[2], SD, -SC) + np.array([XB - XC, YB - YC])
    return 0.5 * C0 * (np.sqrt(spring @ spring) - L0) ** 2 - MOMENT * q[0]


def jacobian(f, q):
    columns = [np.imag(f(q + 1j * STEP * np.eye(7)[i])) / STEP for i in range(7)]
    return np.stack(columns, axis=-1)


def along(f, q, v, step=1e-5):
    """d/dt f(q) twice, along constant v: second derivative by a central difference of exact first derivatives."""
    rate = [np.imag(f(q + s * step * v + 1j * STEP * v)) / STEP for s in (-2, -1, 1, 2)]
    return (rate[0] - 8 * rate[1] + 8 * rate[2] - rate[3]) / (12 * step)


def acceleration(q, v):
    j = jacobian(centers, q)
    w = np.real(jacobian(absolute, q))
    mass = np.einsum("b,bci,bcj->ij", MASS, j, j) + w.T @ np.diag(INERTIA) @ w
    scale = 1e-3 / max(1.0, np.abs(v).max())
    direction = scale * v
    curved = along(centers, q, direction, 1.0) / scale**2
    force = -jacobian(potential, q) - np.einsum("b,bci,bc->i", MASS, j, curved)
    g = jacobian(loops, q)
    matrix = np.block([[mass, g.T], [g, np.zeros((6, 6))]])
    return np.linalg.solve(matrix, np.concatenate([force, -along(loops, q, direction, 1.0) / scale**2]))[:7]


def main():
    def rate(_, y):
        return np.concatenate([y[7:], acceleration(y[:7], y[7:])])

    found = solve_ivp(rate, (0, 0.03), np.concatenate([START, np.zeros(7)]), method="DOP853", rtol=1e-12, atol=1e-12)
    end = found.y[:7, -1]
    print("loops at the end (m):", np.abs(loops(end)).max())
    for name, value, published in zip(("beta", "Theta", "gamma", "Phi", "delta", "Omega", "epsilon"), end, PUBLISHED):
        print(f"{name:8} {value:.12f}  published {published:.12f}  difference {value - published:.1e}")
    assert np.abs(end - PUBLISHED).max() < 1e-7


if __name__ == "__main__":
    main()
