"""Rolling bearings in equilibrium, for crates/bearings/tests: every figure there that is called independent is printed by this script.

    python bearings.py

Shares no code with the Rust workspace: scipy's elliptic integrals and root finders, all unknowns of ring and rolling elements in one
system of equations, the orbit and spin of balls in the form that textbooks print (Harris, after Jones). Units mm, N, MPa, rad.
"""

from math import acos, atan2, cos, pi, radians, sin, tan

import numpy as np
from scipy.optimize import brentq, root
from scipy.special import ellipe, ellipkm1

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
    """A row of balls. sense +1: the inner ring carries forces along +z; 0: deep groove."""

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
        axis = turned(q)
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


def slopes(misfit, x):
    """Jacobian by central differences of 1e-4: coordinates are of the size of micrometres and may be zero."""
    steps = 1e-4 * np.eye(len(x))
    return np.array([(misfit(x + step) - misfit(x - step)) / 2e-4 for step in steps]).T


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
    for _ in range(4):
        x = root(misfit, x, jac=lambda at: slopes(misfit, at), method="hybr", options=dict(xtol=1e-14, maxfev=200000)).x
    size = np.abs(misfit(x)).max()
    assert size < 1e-6 * (1 + np.abs(load).max()), size
    q, v = unpack(x)
    return q, [r.forces(q, vr, speed) for r, vr in zip(rows, v)], v


class Rollers:
    """A row of cylindrical rollers, led along z by the ribs of a ring: each has a place r and a tilt phi about the circumferential direction."""

    def __init__(self, Z, D, L, dm, clearance, laminae=40):
        self.Z, self.D, self.dm = Z, D, dm
        self.l = L / laminae
        self.x = (np.arange(laminae) + 0.5) * self.l - L / 2
        # ISO/TS 16281: Q = 35948 L^(8/9) delta^(10/9) for both races together, each of which takes half of delta.
        self.c = 35948 * L ** (8 / 9) / L * 2 ** (10 / 9) * E_STAR / (206e3 / (2 * (1 - 0.3**2)))
        self.reach = D / 2 - 0.00035 * D * np.log(1 / (1 - (2 * self.x / L) ** 2))
        self.Ri, self.Ro = dm / 2 - D / 2 - clearance / 4, dm / 2 + D / 2 + clearance / 4
        self.psi = 2 * pi * np.arange(Z) / Z

    def line_load(self, approach):
        return self.c * self.l * np.maximum(approach, 0.0) ** (10 / 9)

    def forces(self, q, v):
        """Residuals of the rollers (force along r, moment), force and moment on the inner ring, loads of each roller at both races."""
        axis = turned(q)
        centre = np.array(q[:3])
        F, M, res, rows = np.zeros(3), np.zeros(3), np.zeros((self.Z, 2)), []
        for j, p in enumerate(self.psi):
            er, ez = np.array([cos(p), sin(p), 0]), np.array([0, 0, 1.0])
            r, phi = v[j]
            # Points of the roller's axis; a positive tilt moves its upper end (towards -z) inwards: along = -z at phi = 0.
            along = -(ez * cos(phi) + er * sin(phi))
            points = r * er + self.x[:, None] * along
            w = points - centre
            flat = w - np.outer(w @ axis, axis)
            distance = np.linalg.norm(flat, axis=1)
            normals = flat / distance[:, None]
            Qi = self.line_load(self.reach - (distance - self.Ri))
            Qo = self.line_load(self.reach - (self.Ro - points @ er))
            on_roller = Qi[:, None] * normals - Qo[:, None] * er
            F -= (Qi[:, None] * normals).sum(axis=0)
            M -= np.cross(w, Qi[:, None] * normals).sum(axis=0)
            # Virtual work of a turn of the roller: its points move by d(along)/d(phi) x.
            across = -(-ez * sin(phi) + er * cos(phi))
            res[j] = on_roller.sum(axis=0) @ er, (self.x * (on_roller @ across)).sum()
            rows.append((Qi.sum(), Qo.sum(), Qi.max() / self.l))
        return res, F, M, rows


def turned(q):
    """Axis of the ring: e_z turned by the rotation vector (q3, q4, 0)."""
    t = np.hypot(q[3], q[4])
    if t == 0:
        return np.array([0, 0, 1.0])
    n = np.array([q[3], q[4], 0]) / t
    z = np.array([0, 0, 1.0])
    return z * cos(t) + np.cross(n, z) * sin(t)


def solve_rollers(row, force, moments=None, tilt=(0.0, 0.0), guess=(0.0, 0.0), methods=("lm", "hybr", "hybr")):
    """Ring under (Fx, Fy) with stated moments (N mm), or with a held tilt. Rollers without load stay midway."""
    count = 2 if moments is None else 4
    arm = 3.0

    def unpack(x):
        q = np.array([x[0], x[1], 0, *(tilt if moments is None else x[2:4])])
        q[:2] *= 1e-3
        if moments is not None:
            q[3:] *= 1e-3 / arm
        v = x[count:].reshape(-1, 2) * np.array([1e-3, 1e-3 / arm])
        v[:, 0] += row.dm / 2
        return q, v

    def misfit(x):
        q, v = unpack(x)
        res, F, M, per = row.forces(q, v)
        for j, loads in enumerate(per):
            if loads[0] == 0 and loads[1] == 0:
                res[j] = 1e3 * (v[j] - [row.dm / 2, 0.0])
            else:
                res[j, 1] /= arm
        total = list(F[:2] + np.array(force))
        if moments is not None:
            total += list((M[:2] + np.array(moments)) / row.dm * 2)
        return np.concatenate([total, res.ravel()])

    x = np.zeros(count + 2 * row.Z)
    x[:2] = 1e3 * np.array(guess)
    # Rollers on the loaded side begin pressed.
    for j, p in enumerate(row.psi):
        x[count + 2 * j] = 0.5e3 * (guess[0] * cos(p) + guess[1] * sin(p))
    for method in methods:
        x = root(misfit, x, jac=lambda at: slopes(misfit, at), method=method, options=dict(xtol=1e-14)).x
    size = np.abs(misfit(x)).max()
    assert size < 1e-6 * (1 + np.abs(force).max()), size
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
    # From pure thrust, where all balls carry load, a part of the rest after the other.
    q, v = [0.0, 0.0, 0.1, 0.0, 0.0], None
    for part in np.linspace(0, 1, 6):
        load = [1500 * part, 500 * part, 800, 3000 * part, -4000 * part]
        q, s, v = solve_ball([groove(0.010)], load, guess=q, places=v)
    show("deep groove, 10 um clearance, 1500, 500, 800 N, 3, -4 N m", q, s)

    row = Rollers(12, 7.5, 9.0, 33.5, 0.010)
    q, s = solve_rollers(row, [4000, 1000], guess=[0.020, 0.005])
    show("NU 204, 4000, 1000 N", q, [s])
    q, s = solve_rollers(row, [4000, 1000], tilt=(0.8e-3, -1.5e-3), guess=[0.020, 0.005])
    show("NU 204, 4000, 1000 N, tilt 0.8, -1.5 mrad", q, [s])
    q, s = solve_rollers(row, [4000, 1000], moments=(1500.0, 4000.0), guess=[0.020, 0.005])
    show("NU 204, 4000, 1000 N, 1.5, 4 N m", q, [s])


if __name__ == "__main__":
    main()
