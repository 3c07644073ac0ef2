"""Rolling bearings in equilibrium, for crates/bearings/tests: every figure there that is called independent is printed by this script.

    python bearings.py

Shares no code with the Rust workspace: scipy's elliptic integrals and root finders, all unknowns of ring and rolling elements in one
system of equations, the orbit and spin of balls in the form that textbooks print (Harris, after Jones). Units mm, N, MPa, rad.
"""

from math import acos, atan2, cos, log, pi, radians, sin, sqrt, tan

import numpy as np
from scipy.optimize import brentq, root
from scipy.special import ellipe, ellipk, ellipkm1

E, NU = 206e3, 0.3
E_STAR = 1 / (2 * (1 - NU**2) / E)


def point_stiffness(curvatures_1, curvatures_2):
    """k in Q = k d^1.5 [N/mm^1.5] from the sums of curvatures in the two principal planes."""
    total = curvatures_1 + curvatures_2
    ratio = abs(curvatures_1 - curvatures_2) / total

    def misfit(kappa):
        m = 1 - kappa**-2
        k, e = ellipkm1(kappa**-2), ellipe(m)
        return 1 - 2 / (kappa**2 - 1) * (k / e - 1) - ratio

    kappa = brentq(misfit, 1.01, 1e4, xtol=1e-15, rtol=8.9e-16)
    k, e = ellipkm1(kappa**-2), ellipe(1 - kappa**-2)
    # approach = 2K/(pi a) * 3Q/(4 E*) * ..., in Harris's form with d* = 2F/pi (pi/(2 kappa^2 E))^(1/3)
    d_star = 2 * k / pi * (pi / (2 * kappa**2 * e)) ** (1 / 3)
    # delta = d* [3Q/(2 total) * 1/E*]^(2/3) total/2
    return kappa, (2 / (d_star * total)) ** 1.5 * (2 * total * E_STAR / 3)


class Ball:
    """A row of balls. sense +1: the inner ring bears forces along +z; 0: deep groove."""

    def __init__(self, Z, D, dm, fi, fo, alpha, sense=1, z=0.0, preload=0.0, first=0.0):
        self.Z, self.D, self.dm, self.alpha = Z, D, dm, alpha
        g = D * cos(alpha) / dm
        self.kappa_i, self.Ki = point_stiffness(2 / D - 1 / (fi * D), 2 / D + 2 / D * g / (1 - g))
        self.kappa_o, self.Ko = point_stiffness(2 / D - 1 / (fo * D), 2 / D - 2 / D * g / (1 + g))
        self.ri, self.ro = (fi - 0.5) * D, (fo - 0.5) * D
        self.Ri, self.Ro = dm / 2 + self.ri * cos(alpha), dm / 2 - self.ro * cos(alpha)
        self.zi = z + self.ri * sin(alpha) * sense + preload * sense
        self.zo = z - self.ro * sin(alpha) * sense
        self.psi = first + 2 * pi * np.arange(Z) / Z
        self.z0 = z

    def start(self, q):
        """Ball centres halfway between the grooves' centres."""
        v = []
        for p in self.psi:
            u = q[0] * cos(p) + q[1] * sin(p)
            c = np.array([self.Ri + u, self.zi + q[2] + (q[3] * sin(p) - q[4] * cos(p)) * self.Ri])
            o = np.array([self.Ro, self.zo])
            d = np.linalg.norm(c - o)
            v.append(o + (c - o) / d * (self.ro + 0.5 * max(d - self.ri - self.ro, 1e-5)))
        return np.array(v)

    def forces(self, q, v, speed=0.0, unloaded_scale=1.0):
        """Residuals of the balls (Z, 2), force and moment on the inner ring, Q_i, Q_o and contact angles."""
        theta = np.array([q[3], q[4], 0.0])
        t = np.linalg.norm(theta)
        axis = np.array([0, 0, 1.0])
        if t > 0:
            n = theta / t
            axis = axis * cos(t) + np.cross(n, axis) * sin(t) + n * n.dot(axis) * (1 - cos(t))
        centre = np.array(q[:3])
        F, M = np.zeros(3), np.zeros(3)
        res, rows = np.zeros((self.Z, 2)), []
        for j, p in enumerate(self.psi):
            er = np.array([cos(p), sin(p), 0])
            b = er * v[j, 0] + np.array([0, 0, v[j, 1]])
            # Nearest point of the circle of the inner groove's centres.
            w = b - centre
            flat = w - w.dot(axis) * axis
            nearest = centre + axis * self.zi + self.Ri * flat / np.linalg.norm(flat)
            pull = nearest - b
            li = np.linalg.norm(pull)
            Qi = self.Ki * max(li - self.ri, 0) ** 1.5
            on_ball = Qi * pull / li
            do = v[j] - np.array([self.Ro, self.zo])
            lo = np.linalg.norm(do)
            Qo = self.Ko * max(lo - self.ro, 0) ** 1.5
            res[j] = [on_ball.dot(er), on_ball[2]] - Qo * do / lo
            # Contact angles, in the axial plane of each ring.
            e = flat / np.linalg.norm(flat)
            ai, ao = atan2(pull.dot(axis), pull.dot(e)), atan2(do[1], do[0])
            Fc = Mg = 0.0
            if speed:
                g = self.D / self.dm
                beta = atan2(sin(ao), cos(ao) + g)
                tb = tan(beta)
                wm = speed / (1 + (1 + g * cos(ao)) * (cos(ai) + tb * sin(ai)) / ((1 - g * cos(ai)) * (cos(ao) + tb * sin(ao))))
                wr = speed / (((cos(ao) + tb * sin(ao)) / (1 + g * cos(ao)) + (cos(ai) + tb * sin(ai)) / (1 - g * cos(ai))) * g * cos(beta))
                mass = 7850e-12 * pi / 6 * self.D**3  # tonne
                Fc = 0.5 * mass * self.dm * wm**2
                Mg = mass * self.D**2 / 10 * wm * wr * sin(beta)
                res[j] += [Fc, 0]
                res[j] += 2 * Mg / self.D * np.array([sin(ao), -cos(ao)])
            F -= on_ball
            M -= np.cross(w, on_ball)
            rows.append((Qi, Qo, ai, ao, Fc, Mg))
        return res, F, M, rows


def solve_ball(rows, load, speed=0.0, guess=None, held=(), places=None):
    """Ring coordinates under (Fx, Fy, Fz, Mx, My); `held` names coordinates that stay at zero.
    `places`: where the balls' centres begin, returned third."""
    arm = rows[0].dm / 2
    free = [i for i in range(5) if i not in held]
    q0 = np.zeros(5) if guess is None else np.array(guess, float)
    v0 = [r.start(q0) for r in rows] if places is None else places

    def unpack(x):
        q = np.zeros(5)
        q[free] = x[: len(free)] * np.array([1e-3 if i < 3 else 1e-3 / arm for i in free])
        at, v = len(free), []
        for r, start in zip(rows, v0):
            v.append(start + 1e-3 * x[at : at + 2 * r.Z].reshape(-1, 2))
            at += 2 * r.Z
        return q, v

    def misfit(x):
        q, v = unpack(x)
        total, out = np.array(load, float), []
        for r, vr in zip(rows, v):
            res, F, M, per = r.forces(q, vr, speed)
            total[:3] += F
            total[3:] += M[:2]
            # A ball that nothing presses stays where it was put: any place will do.
            for j, row in enumerate(per):
                if row[0] == 0 and row[1] == 0 and speed == 0:
                    res[j] = 1e3 * (vr[j] - r.start(q)[j])
            out.append(res.ravel())
        scaled = total / np.array([1, 1, 1, arm, arm])
        return np.concatenate([scaled[free]] + out)

    x = np.zeros(len(free) + sum(2 * r.Z for r in rows))
    x[: len(free)] = q0[free] / np.array([1e-3 if i < 3 else 1e-3 / arm for i in free])
    # Differences take steps in proportion to the unknowns: rounding in place of zero would make them vanish.
    x[np.abs(x) < 1e-7] = 0.0
    for method, options in (("lm", dict(xtol=1e-15, ftol=1e-15)), ("hybr", dict(xtol=1e-14)), ("lm", dict(xtol=1e-15, ftol=1e-15))):
        x = root(misfit, x, method=method, options=options).x
    size = np.abs(misfit(x)).max()
    assert size < 1e-6 * (1 + np.abs(load).max()), size
    q, v = unpack(x)
    return q, [r.forces(q, vr, speed) for r, vr in zip(rows, v)], v


LINE = 35948 * 2 ** (10 / 9)


class Roller:
    """A row of cylindrical (alpha 0) rollers; laminae at their middles."""

    def __init__(self, Z, D, L, dm, clearance, laminae, scale):
        self.Z, self.D, self.L, self.dm, self.s = Z, D, L, dm, clearance
        self.x = (np.arange(laminae) + 0.5) * L / laminae - L / 2
        self.dx = L / laminae
        self.P = scale * np.log(1 / (1 - (2 * self.x / L) ** 2))
        self.psi = 2 * pi * np.arange(Z) / Z
        self.c = LINE * L ** (-1 / 9)

    def forces(self, q, v):
        """v: (Z, 2) radius and tilt of each roller's axis."""
        theta = np.array([q[3], q[4], 0.0])
        t = np.linalg.norm(theta)
        axis = np.array([0, 0, 1.0])
        if t > 0:
            n = theta / t
            axis = axis * cos(t) + np.cross(n, axis) * sin(t) + n * n.dot(axis) * (1 - cos(t))
        centre = np.array(q[:3])
        Ri = self.dm / 2 - self.D / 2 - self.s / 4
        Ro = self.dm / 2 + self.D / 2 + self.s / 4
        F, M, res, loads = np.zeros(3), np.zeros(3), np.zeros((self.Z, 2)), []
        for j, p in enumerate(self.psi):
            er = np.array([cos(p), sin(p), 0])
            Q = [0.0, 0.0]
            for x, P in zip(self.x, self.P):
                # The roller's axis points along -z, tilted about the circumferential direction.
                along = np.array([-sin(v[j, 1]), -cos(v[j, 1])])
                place = np.array([v[j, 0], 0.0]) + x * along
                b = er * place[0] + np.array([0, 0, place[1]])
                w = b - centre
                flat = w - w.dot(axis) * axis
                r = np.linalg.norm(flat)
                qi = self.c * self.dx * max(self.D / 2 - P - (r - Ri), 0) ** (10 / 9)
                qo = self.c * self.dx * max(self.D / 2 - P - (Ro - place[0]), 0) ** (10 / 9)
                on_roller = qi * flat / r
                F -= on_roller
                M -= np.cross(w, on_roller)
                radial = on_roller.dot(er) - qo
                res[j, 0] += radial
                # virtual work of the tilt: d place/d tilt = x (-cos, sin)
                res[j, 1] += radial * x * -cos(v[j, 1]) + on_roller[2] * x * sin(v[j, 1])
                Q[0] += qi
                Q[1] += qo
            loads.append(Q)
        return res, F, M, loads


def solve_roller(row, radial, tilt, guess):
    """Displacements x, y under a radial load with the ring's tilt held."""

    def unpack(x):
        q = np.array([1e-3 * x[0], 1e-3 * x[1], 0.0, tilt[0], tilt[1]])
        v = np.zeros((row.Z, 2))
        v[:, 0] = row.dm / 2 + 1e-3 * x[2 : 2 + row.Z]
        v[:, 1] = 1e-3 * x[2 + row.Z :]
        return q, v

    def misfit(x):
        q, v = unpack(x)
        res, F, M, loads = row.forces(q, v)
        for j, Q in enumerate(loads):
            if Q[0] == 0 and Q[1] == 0:
                u = 0.5 * (q[0] * cos(row.psi[j]) + q[1] * sin(row.psi[j]))
                res[j] = 1e3 * np.array([v[j, 0] - row.dm / 2 - u, row.L * v[j, 1]])
        return np.concatenate([F[:2] + radial, res[:, 0], res[:, 1] / (row.L / 4)])

    x = np.zeros(2 + 2 * row.Z)
    x[:2] = guess
    for j, p in enumerate(row.psi):
        x[2 + j] = 0.5 * (guess[0] * cos(p) + guess[1] * sin(p))
        x[2 + row.Z + j] = 1e3 * 0.5 * (tilt[0] * -sin(p) + tilt[1] * cos(p))
    for method, options in (("lm", dict(xtol=1e-15, ftol=1e-15)), ("hybr", dict(xtol=1e-14)), ("lm", dict(xtol=1e-15, ftol=1e-15))):
        x = root(misfit, x, method=method, options=options).x
    assert np.abs(misfit(x)).max() < 1e-5, np.abs(misfit(x)).max()
    q, v = unpack(x)
    return q, row.forces(q, v)


def show(name, q, sets):
    print(name)
    print("  x y z [um]", *(f"{1e3 * c:.9f}" for c in q[:3]), " tilt [mrad]", *(f"{1e3 * c:.9f}" for c in q[3:]))
    for _, F, M, rows in sets:
        print("  F [N]", *(f"{c:.7f}" for c in F), " M [N m]", *(f"{1e-3 * c:.9f}" for c in M))
        for row in rows:
            print("   ", *(f"{value:.9g}" for value in row))


def main():
    thrust = Ball(16, 22.23, 125.3, 0.5232, 0.5232, radians(40))
    print("218: kappa, K", thrust.kappa_i, thrust.Ki, thrust.kappa_o, thrust.Ko)
    q, s, v = solve_ball([thrust], [0, 0, 17800, 0, 0], guess=[0, 0, 0.036, 0, 0])
    show("218 thrust 17800 N", q, [(s[0][0], s[0][1], s[0][2], s[0][3][:1])])
    for rpm in range(1000, 10001, 1000):
        q, s, v = solve_ball([thrust], [0, 0, 17800, 0, 0], speed=rpm * pi / 30, guess=q, places=v)
        if rpm == 10000:
            show(f"218 thrust 17800 N at {rpm} rpm", q, [(s[0][0], s[0][1], s[0][2], s[0][3][:1])])
    q, v = [0.0, 0.0, 0.036, 0.0, 0.0], None
    for rpm in (0, 2000, 4000, 6000):
        q, s, v = solve_ball([thrust], [4000, 1000, 17800, 50000, -80000], speed=rpm * pi / 30, guess=q, places=v)
    show("218 combined load at 6000 rpm", q, s)

    def groove(clearance):
        A = 0.05 * 7.938
        return Ball(9, 7.938, 39.04, 0.52, 0.53, acos(1 - clearance / (2 * A)), sense=0)

    q, s, _ = solve_ball([groove(0)], [2000, 0, 0, 0, 0], guess=[0.012, 0, 0, 0, 0], held=(1, 2, 3, 4))
    show("deep groove, 2000 N radial, no clearance", q, s)
    q, s, _ = solve_ball([groove(0.015)], [2000, 0, 0, 0, 0], guess=[0.022, 0, 0, 0, 0], held=(1, 2, 3, 4))
    show("deep groove, 2000 N radial, 15 um clearance", q, s)
    q, v = [0.0, 0.0, 0.1, 0.0, 0.0], None
    for share in (0, 0.1, 0.2, 0.4, 0.6, 0.8, 1):
        load = [800 * share, 300 * share, 1500, 5000 * share, -8000 * share]
        q, s, v = solve_ball([groove(0.010)], load, guess=q, places=v)
    show("deep groove, combined load and moment, 10 um clearance", q, s)

    pair = [
        Ball(19, 8.731, 65, 0.52, 0.53, radians(15), 1, -8.0, 0.005),
        Ball(19, 8.731, 65, 0.52, 0.53, radians(15), -1, 8.0, 0.005),
    ]
    q, v = [0.0] * 5, None
    for share in (0, 0.25, 0.5, 0.75, 1):
        load = [600 * share, -200 * share, 300 * share, 10000 * share, 4000 * share]
        q, s, v = solve_ball(pair, load, guess=q, places=v)
    show("7010C pair, O, 16 mm apart, pressed in by 5 um each", q, s)

    row = Roller(12, 7.5, 9.0, 33.5, 0.010, 40, 0.35e-3 * 7.5)
    q, s = solve_roller(row, [5000.0, 0.0], [0.0, 0.0], [12.0, 0.0])
    show("cylindrical roller, 5000 N radial", q, [s])
    q, s = solve_roller(row, [5000.0, 1000.0], [0.4e-3, 1.0e-3], [12.0, 2.0])
    show("cylindrical roller, 5000 and 1000 N radial, tilt 0.4 and 1 mrad", q, [s])


if __name__ == "__main__":
    main()
