"""Four-point, thrust, double-row and spherical roller bearings by their least energy, for crates/bearings/tests: every figure there that is
called independent and of these types is printed by this script.

    python bearing_types.py

Shares no code with the Rust workspace and none of its ways: the energy of all contacts and loads is a function of the ring's five
coordinates and the places of all balls or rollers; its gradient is taken by complex steps and its least value sought in all unknowns at
once. Hertz' stiffness is that of bearings.py. Units mm, N, MPa, rad.
"""

from math import cos, pi, radians, sin, tan

import numpy as np
from bearings import E_STAR, point_stiffness

STEP = 1e-30j


def positive(x):
    """x where its real part is positive, else 0; for complex steps."""
    return np.where(x.real > 0, x, 0)


def axis_of(q):
    """e_z turned by the rotation vector (q3, q4, 0)."""
    t2 = q[3] ** 2 + q[4] ** 2
    t = np.sqrt(t2 + 1e-60)
    s = np.sin(t) / t
    return np.array([q[4] * s, -q[3] * s, np.cos(t)])


def moved(q):
    """Rotation matrix of the least turn that takes e_z to the axis."""
    a = axis_of(q)
    c = 1 / (1 + a[2])
    return np.array(
        [
            [1 - a[0] * a[0] * c, -a[0] * a[1] * c, a[0]],
            [-a[0] * a[1] * c, 1 - a[1] * a[1] * c, a[1]],
            [-a[0], -a[1], a[2]],
        ]
    )


class Balls:
    """A row of balls between arcs: lists of (radius of the circle of centres, its z, arm, stiffness, test of the angle's cosine and sine)."""

    unknowns = 2

    def __init__(self, Z, dm, inner, outer, z=0.0, first=0.0):
        self.Z, self.dm, self.inner, self.outer, self.z = Z, dm, inner, outer, z
        psi = first + 2 * pi * np.arange(Z) / Z
        self.er = np.stack([np.cos(psi), np.sin(psi), 0 * psi], axis=1)
        self.et = np.stack([-np.sin(psi), np.cos(psi), 0 * psi], axis=1)

    def start(self, q):
        """Halfway."""
        u = self.er @ np.array(q[:3])
        w = q[2] + self.dm / 2 * (q[3] * self.er[:, 1] - q[4] * self.er[:, 0])
        return np.stack([self.dm / 2 + 0.5 * u, self.z + 0.5 * w], axis=1)

    def approaches(self, q, v):
        a = axis_of(q)
        b = self.er * v[:, :1] + np.array([0, 0, 1.0]) * v[:, 1:]
        w = b - q[:3]
        h = w @ a
        flat = w - h[:, None] * a
        rho = np.sqrt((flat * flat).sum(axis=1))
        out = []
        for race, arcs, (r, z), sign in (("i", self.inner, (rho, h), -1), ("o", self.outer, (v[:, 0], v[:, 1]), 1)):
            for R, zc, arm, K, on in arcs:
                d, e = sign * (r - R), sign * (z - zc)
                l = np.sqrt(d * d + e * e)
                delta = np.where(on(d.real / l.real, e.real / l.real), positive(l - arm), 0)
                out.append((race, K, delta, np.arctan2(e.real, d.real)))
        return out

    def energy(self, q, v):
        return sum(0.4 * K * delta**2.5 for _, K, delta, _ in self.approaches(q, v))

    def loads(self, q, v):
        """For each contact list: loads and angles."""
        return [(race, K * delta.real**1.5, angle) for race, K, delta, angle in self.approaches(q, v)]


def curvature_stiffness(D, dm, f, alpha, side):
    g = D * cos(alpha) / dm
    along = 2 / D + 2 / D * g / (1 - g) if side == "i" else 2 / D - 2 / D * g / (1 + g)
    return point_stiffness(2 / D - 1 / (f * D), along)[1]


def radial(c, s):
    return c > 0


def upwards(c, s):
    return s > 0


def angular(Z, D, dm, fi, fo, alpha, sense=1, z=0.0, first=0.0):
    ri, ro = (fi - 0.5) * D, (fo - 0.5) * D
    Ki, Ko = (curvature_stiffness(D, dm, f, alpha, side) for f, side in ((fi, "i"), (fo, "o")))
    inner = [(dm / 2 + ri * cos(alpha), z + sense * ri * sin(alpha), ri, Ki, radial)]
    outer = [(dm / 2 - ro * cos(alpha), z - sense * ro * sin(alpha), ro, Ko, radial)]
    return Balls(Z, dm, inner, outer, z, first)


def four_point(Z, D, dm, fi, fo, alpha, play=0.0, first=0.0):
    ri, ro = (fi - 0.5) * D, (fo - 0.5) * D
    c = cos(alpha) - play / (2 * (ri + ro))
    Ki, Ko = (curvature_stiffness(D, dm, f, alpha, side) for f, side in ((fi, "i"), (fo, "o")))
    ends = [r * sin(alpha) / (f * D) for r, f in ((ri, fi), (ro, fo))]

    def on(side, end):
        return lambda cosine, sine: (cosine > 0) & (side * sine > end)

    inner = [(dm / 2 + ri * c, side * ri * sin(alpha), ri, Ki, on(side, ends[0])) for side in (1, -1)]
    outer = [(dm / 2 - ro * c, -side * ro * sin(alpha), ro, Ko, on(side, ends[1])) for side in (1, -1)]
    return Balls(Z, dm, inner, outer, first=first)


def thrust(Z, D, dm, fi, fo, first=0.0):
    ri, ro = (fi - 0.5) * D, (fo - 0.5) * D
    Ki, Ko = (curvature_stiffness(D, dm, f, pi / 2, side) for f, side in ((fi, "i"), (fo, "o")))
    return Balls(Z, dm, [(dm / 2, ri, ri, Ki, upwards)], [(dm / 2, -ro, ro, Ko, upwards)], first=first)


class Barrels:
    """A row of barrel rollers between the inner ring's groove and the sphere inside the outer ring, in the axes of the inner ring. A
    roller has a place (r, z) and a tilt; its laminae are circles about its axis."""

    unknowns = 3

    def __init__(self, Z, D, L, dm, alpha, Rr, Ri, Ro, sense, play=0.0, laminae=40, first=0.0):
        self.Z, self.dm, self.alpha, self.sense = Z, dm, alpha, sense
        self.l = L / laminae
        self.x = (np.arange(laminae) + 0.5) * self.l - L / 2
        self.reach = D / 2 - self.x**2 / (Rr + np.sqrt(Rr**2 - self.x**2))
        self.c = 35948 * L ** (-1 / 9) * 2 ** (10 / 9) * E_STAR / (206e3 / (2 * (1 - 0.3**2)))
        psi = first + 2 * pi * np.arange(Z) / Z
        self.er = np.stack([np.cos(psi), np.sin(psi)], axis=1)
        self.Ri, self.Ro = Ri, Ro + play / 4 * cos(alpha)
        # Outwards along the load line, and the roller's middle, which the sphere's centre sees at the contact angle.
        n = np.array([cos(alpha), sense * sin(alpha)])
        self.middle = np.array([dm / 2, dm / 2 * tan(alpha) * sense])
        self.n = n
        self.groove = self.middle + n * (Ri - D / 2 - play / 4 * cos(alpha))

    def start(self, q):
        R = moved(q)
        s = -(R.T @ np.array(q[:3]))
        half = 0.5 * (self.er @ s[:2])
        v = np.zeros((self.Z, 3))
        v[:, 0] = self.middle[0] + half
        v[:, 1] = self.middle[1] + 0.5 * s[2]
        return v

    def approaches(self, q, v):
        s = -(moved(q).T @ q[:3])
        r, z, phi = v[:, :1], v[:, 1:2], v[:, 2:]
        c, s_ = np.cos(phi), np.sin(phi)
        # Across the roller outwards and along it, turned by phi from r towards z.
        ur, uz = self.n[0] * c - self.n[1] * s_, self.n[1] * c + self.n[0] * s_
        pr, pz = r - uz * self.x, z + ur * self.x
        out_r, out_z = pr + ur * self.reach, pz + uz * self.reach
        in_r, in_z = pr - ur * self.reach, pz - uz * self.reach
        # The sphere's centre in the roller's plane and beside it; the two rows have one sphere.
        sr = self.er @ s[:2]
        st = self.er[:, 1] * s[0] - self.er[:, 0] * s[1]
        dr, dz = out_r - sr[:, None], out_z - s[2]
        outer = np.sqrt(dr * dr + dz * dz + (st * st)[:, None]) - self.Ro
        gr, gz = in_r - self.groove[0], in_z - self.groove[1]
        inner = np.sqrt(gr * gr + gz * gz) - self.Ri
        return positive(inner), positive(outer)

    def energy(self, q, v):
        return sum((9 / 19 * self.c * self.l * d ** (19 / 9)).sum(axis=1) for d in self.approaches(q, v))

    def loads(self, q, v):
        inner, outer = (self.c * self.l * d.real ** (10 / 9) for d in self.approaches(q, v))
        angle = np.full(self.Z, self.alpha * self.sense)
        return [("i", inner.sum(axis=1), angle), ("o", outer.sum(axis=1), angle)]


def spherical(Z, D, L, dm, alpha, Rr=None, Ri=None, play=0.0, first=0.0):
    """Both rows: that which carries axial loads towards -z first."""
    Ro = dm / 2 / cos(alpha) + D / 2
    Rr, Ri = Rr or 0.97 * Ro, Ri or Ro
    return [Barrels(Z, D, L, dm, alpha, Rr, Ri, Ro, sense, play, first=first) for sense in (-1, 1)]


def derivatives(rows, q, vs):
    """Energy, its gradient by q and by the places, and its second derivatives by differences of the gradient."""

    def gradient(q, vs):
        by_q, by_v = np.zeros(5), []
        for i in range(5):
            moved_q = q.astype(complex)
            moved_q[i] += STEP
            by_q[i] = sum(row.energy(moved_q, v).sum().imag for row, v in zip(rows, vs)) / STEP.imag
        for row, v in zip(rows, vs):
            columns = []
            for k in range(row.unknowns):
                moved_v = v.astype(complex)
                moved_v[:, k] += STEP
                columns.append(row.energy(q.astype(complex), moved_v).imag / STEP.imag)
            by_v.append(np.stack(columns, axis=1))
        return by_q, by_v

    by_q, by_v = gradient(q, vs)
    h = 1e-7
    qq, qv = np.zeros((5, 5)), [np.zeros((row.Z, row.unknowns, 5)) for row in rows]
    for i in range(5):
        # Tilts by the same way at the rows.
        step = np.zeros(5)
        step[i] = h if i < 3 else h / rows[0].dm
        up, down = gradient(q + step, vs), gradient(q - step, vs)
        qq[:, i] = (up[0] - down[0]) / (2 * step[i])
        for place, (u, d) in enumerate(zip(up[1], down[1])):
            qv[place][:, :, i] = (u - d) / (2 * step[i])
    vv = []
    for place, row in enumerate(rows):
        block = np.zeros((row.Z, row.unknowns, row.unknowns))
        for k in range(row.unknowns):
            step = h if k < 2 else h / 10
            other = [v.copy() for v in vs]
            other[place][:, k] += step
            up = gradient(q, other)[1][place]
            other[place][:, k] -= 2 * step
            block[:, :, k] = (up - gradient(q, other)[1][place]) / (2 * step)
        vv.append(0.5 * (block + block.transpose(0, 2, 1)))
    return by_q, by_v, 0.5 * (qq + qq.T), qv, vv


def rest(rows, force, q=None, held=(), centrifugal=0.0):
    """Coordinates of the ring and places of all elements under a force, by Newton's method on the energy of all unknowns, damped as by
    Levenberg and Marquardt. `held` coordinates stay as they are."""
    q = np.zeros(5) if q is None else np.array(q, float)
    vs = [row.start(q) for row in rows]
    arm = rows[0].dm / 2
    scale_q = np.array([1, 1, 1, 1 / arm, 1 / arm])
    scale_v = np.concatenate([np.tile([1.0, 1.0] if row.unknowns == 2 else [1.0, 1.0, 0.1], row.Z) for row in rows])
    scale = np.concatenate([scale_q, scale_v])
    free = np.ones(len(scale), bool)
    free[list(held)] = False
    load = np.zeros(5)
    load[:3] = force

    def energy(q, vs):
        inside = sum(row.energy(q.astype(complex), v).sum().real for row, v in zip(rows, vs))
        thrown = centrifugal * sum((v[:, 0] - row.dm / 2).sum() for row, v in zip(rows, vs))
        return inside - load @ q - thrown

    damping, now = 1e-3, energy(q, vs)
    size, tiny = np.inf, 0
    for _ in range(400):
        by_q, by_v, qq, qv, vv = derivatives(rows, q, vs)
        for v in by_v:
            v[:, 0] -= centrifugal
        g = np.concatenate([by_q - load] + [v.ravel() for v in by_v]) * scale
        n = len(g)
        H = np.zeros((n, n))
        H[:5, :5] = qq
        at = 5
        for row, cross, block in zip(rows, qv, vv):
            m = row.unknowns
            for j in range(row.Z):
                H[at : at + m, at : at + m] = block[j]
                H[at : at + m, :5] = cross[j]
                H[:5, at : at + m] = cross[j].T
                at += m
        H *= np.outer(scale, scale)
        size = np.abs(g[free]).max()
        if size < 1e-9 * (1 + np.abs(load).max()):
            break
        stiff = np.abs(np.diag(H)).max()
        while True:
            lift = damping * stiff
            step = np.zeros(n)
            step[free] = np.linalg.solve(H[np.ix_(free, free)] + lift * np.eye(free.sum()), -g[free])
            step *= min(1.0, 0.05 / np.abs(step).max())
            step *= scale
            new_q = q + step[:5]
            new_vs, at = [], 5
            for row, v in zip(rows, vs):
                new_vs.append(v + step[at : at + v.size].reshape(v.shape))
                at += v.size
            new = energy(new_q, new_vs)
            if new <= now + 1e-13 * abs(now) + 1e-16 or damping > 1e8:
                break
            damping = max(10 * damping, 1e-12)
        tiny = tiny + 1 if damping > 1e8 else 0
        if tiny:
            damping = 1e-14
            if tiny > 2:
                break
        q, vs, now = new_q, new_vs, new
        damping *= 0.1 if damping > 1e-14 else 1.0
    assert size < 1e-6 * (1 + np.abs(load).max()), size
    # Moment about the ring's middle: minus the derivative of the energy by a turn, its third part left out.
    return q, vs, by_q


def report(rows, q, vs):
    return [[(race, load.tolist(), angle.tolist()) for race, load, angle in row.loads(q, v)] for row, v in zip(rows, vs)]


def show(name, rows, q, vs):
    print(name)
    print("  x y z [um]", *(f"{1e3 * c:.9f}" for c in q[:3]), " tilt [mrad]", *(f"{1e3 * c:.9f}" for c in q[3:]))
    for place, row in enumerate(report(rows, q, vs)):
        for race, load, angle in row:
            print("  row", place + 1, race, *(f"{x:.9g}" for x in load[:4]), " angle", *(f"{x:.9g}" for x in angle[:4]))


def main():
    row = four_point(15, 12.7, 70.0, 0.52, 0.53, radians(35), 0.02)
    q, vs, _ = rest([row], [3000, 500, 2000], q=[0.01, 0, 0.01, 0, 0])
    show("QJ, 20 um of play, 3000, 500, 2000 N, free to tilt", [row], q, vs)
    q, vs, _ = rest([row], [300, 0, 9000], q=[0.0, 0, 0.02, 0, 0])
    show("QJ, 300, 0, 9000 N", [row], q, vs)
    row = thrust(14, 7.938, 36.0, 0.54, 0.54)
    q, vs, _ = rest([row], [200, 50, 5000], q=[0, 0, 0.01, 0, 0])
    show("thrust, 200, 50, 5000 N, free to tilt", [row], q, vs)
    for name, senses in (("O", (1, -1)), ("X", (-1, 1))):
        pair = [angular(13, 7.938, 38.5, 0.52, 0.53, radians(30), s, z) for s, z in zip(senses, (-5.15, 5.15))]
        q, vs, _ = rest(pair, [2000, 0, 1500], q=[0.01, 0, 0.02, 0, 0])
        show(f"double row, {name}, 2000, 0, 1500 N, free to tilt", pair, q, vs)
    pair = spherical(19, 23.0, 17.0, 140.0, radians(9), play=0.04)
    for force in ([40000, 5000, 2000], [3000, 1000, 30000]):
        q, vs, _ = rest(pair, force, q=[0.03, 0.01, 0.05, 0, 0], held=(3, 4))
        show(f"spherical, {force} N", pair, q, vs)


if __name__ == "__main__":
    main()
