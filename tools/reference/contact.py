"""Sliced contact of a spur pair on the line of action, load given. Half width z >= 0. N, mm, rad.

Coulomb friction mu: towards the roots of both gears before the pitch point, towards both tips after it, none in it. The driven
gear's surface runs towards its tip there, so that friction towards the tip helps to turn it: its lever arm is rho_2 = r_b2 xi_2.
With `bends`, the friction's own part of the normal deflection is counted; the method that is checked leaves it out.
"""

import numpy as np

from fe import E_MPA, NU

STRIP = 2 * (1 - NU**2) / (np.pi * E_MPA)
Q_FLOOR = 0.5  # N/mm: below it the Hertz half width is held (keeps the logarithm finite)


class Pair:
    """Gear 1 drives. teeth of pair p: gear 1 tooth p, gear 2 tooth -p."""

    def __init__(self, gear1, gear2, near1, near2, centre_distance=150.0, crown_mm=0.010, mu=0.0, bends=False):
        self.mu, self.bends = mu, bends
        self.g, self.near = (gear1, gear2), (near1, near2)
        t1, t2 = gear1.tooth, gear2.tooth
        self.t = (t1, t2)
        self.a = centre_distance
        self.alpha_w = np.arccos((t1.r_base + t2.r_base) / centre_distance)
        self.line = centre_distance * np.sin(self.alpha_w)
        self.xi_ref, self.crown = t1.xi(75.0), crown_mm
        self.width = np.diff(gear1.edges)
        assert np.allclose(gear1.edges, gear2.edges)

    def pairs(self, theta1):
        """[(p, xi1, xi2)] inside the path of contact; p counted from the angle, not reduced to one revolution."""
        t1, t2 = self.t
        out = []
        p0 = int(np.floor(theta1 / t1.pitch_angle))
        for p in range(p0 - 3, p0 + 4):
            xi1 = np.tan(self.alpha_w) + theta1 - p * t1.pitch_angle
            xi2 = (self.line - t1.r_base * xi1) / t2.r_base
            if xi1 <= t1.xi_tip and xi2 <= t2.xi_tip:
                out.append((p, xi1, xi2))
        return out

    def crowning(self, xi1):
        return self.crown * ((xi1 - self.xi_ref) / (self.t[0].xi_tip - self.xi_ref)) ** 2

    def friction(self, xi1):
        """Friction over normal force, positive towards the tips."""
        return self.mu * np.sign(round(xi1 - np.tan(self.alpha_w), 12))

    def system(self, theta1):
        """Compliance (mm/N), initial gaps (mm), kappa (mm per N/mm), equivalent radius (mm), slice widths and lever arms about
        the driven axis over r_b2 of all slices."""
        ps, ns = self.pairs(theta1), len(self.width)
        n = len(ps) * ns
        C = np.zeros((n, n))
        pats = [[g.pattern(xi) for g, xi in zip(self.g, (x1, x2))] for _, x1, x2 in ps]
        for i, (p, *_) in enumerate(ps):
            for j, (q, *_) in enumerate(ps):
                b1 = self.g[0].block(p, q)[: self.g[0].n_load, : self.g[0].n_load]
                b2 = self.g[1].block(-p, -q)[: self.g[1].n_load, : self.g[1].n_load]
                load = pats[j]
                if self.bends:
                    f = self.friction(ps[j][1])
                    load = [n + f * g.pattern(xi, along=True) for n, g, xi in zip(pats[j], self.g, ps[j][1:])]
                C[i * ns : (i + 1) * ns, j * ns : (j + 1) * ns] = pats[i][0] @ b1 @ load[0].T + pats[i][1] @ b2 @ load[1].T
        if not self.bends:
            C = (C + C.T) / 2
        gap = np.repeat([self.crowning(x1) for _, x1, _ in ps], ns)
        kap = np.repeat([self.near[0].kappa(x1) + self.near[1].kappa(x2) for _, x1, x2 in ps], ns)
        rho = np.repeat([1 / (1 / (self.t[0].r_base * x1) + 1 / (self.t[1].r_base * x2)) for _, x1, x2 in ps], ns)
        arm = np.repeat([1 + self.friction(x1) * x2 for _, x1, x2 in ps], ns)
        return ps, C, gap, kap, rho, np.tile(self.width, len(ps)), arm

    def solve(self, system, torque_nm, a0):
        """TE (mm, negative under load) and slice forces (N, of the half width) for a driven torque."""
        ps, C, gap, kap, rho, b, arm = system
        total = torque_nm * 1e3 / self.t[1].r_base / 2  # half the width carries half the load
        n = len(gap)
        e_star = E_MPA / (2 * (1 - NU**2))
        k_a = 4 * rho / (np.pi * e_star)

        def local(F):
            """Near-field deflection and its derivative: both bodies carry -STRIP ln(a / a0)."""
            q = F / b
            qf = np.maximum(q, Q_FLOOR)
            lnq = kap - 2 * STRIP * 0.5 * np.log(k_a * qf / a0**2)
            return q * lnq, (lnq - np.where(q > Q_FLOOR, STRIP, 0)) / b

        active = np.ones(n, bool)
        F, te = total * b / b.sum(), 0.0
        for _ in range(200):
            for _ in range(60):
                loc, dloc = local(F)
                A = np.flatnonzero(active)
                r = gap[A] + te + C[np.ix_(A, A)] @ F[A] + loc[A]
                J = np.zeros((len(A) + 1, len(A) + 1))
                J[:-1, :-1] = C[np.ix_(A, A)] + np.diag(dloc[A])
                J[:-1, -1] = 1
                J[-1, :-1] = arm[A]
                d = np.linalg.solve(J, -np.concatenate([r, [arm[A] @ F[A] - total]]))
                F = F.copy()
                F[A] += d[:-1]
                te += d[-1]
                if np.abs(d[:-1]).max() < 1e-10 * total and abs(d[-1]) < 1e-14:
                    break
            else:
                raise RuntimeError("Newton iteration did not converge")
            loc, _ = local(F)
            g = gap + te + C @ F + loc
            if active.any() and F[active].min() < 0:
                active &= F > 0
                F = np.where(active, F, 0.0)
                continue
            worst = np.where(active, np.inf, g)
            if worst.min() < -1e-13:
                active[np.argmin(worst)] = True
                continue
            assert np.abs(g[active]).max() < 1e-12 and abs(arm @ F - total) < 1e-8 * total
            return te, F
        raise RuntimeError("active set did not settle")
