"""Rack-generated spur tooth: involute, trochoid fillet, pair kinematics. Lengths in mm, angles in rad.

The profile is given for the side of positive polar angle (tooth centre on the x axis); the other side is its mirror image.
"""

import numpy as np


class Tooth:
    """One tooth of a spur gear cut by a rack with a rounded tip."""

    def __init__(self, z=57, m=2.6, alpha_deg=20.0, x=0.33, addendum=1.0, dedendum=1.25, rho=0.38):
        a = np.deg2rad(alpha_deg)
        self.z, self.m, self.alpha, self.x = z, m, a, x
        self.r = m * z / 2
        self.r_base = self.r * np.cos(a)
        self.r_tip = m * (z / 2 + x + addendum)
        self.r_root = m * (z / 2 + x - dedendum)
        self.pitch_angle = 2 * np.pi / z
        # half tooth thickness angle at the reference circle, then at the base circle
        half = np.pi / (2 * z) + 2 * x * np.tan(a) / z
        self.half_base = half + np.tan(a) - a
        # rack tip rounding: centre below the pitch line (y) and sideways (X), as seen from the tooth centre
        self.rho = rho * m
        self.yc = x * m - dedendum * m + self.rho
        self.xc = np.pi * m / 4 + (x * m - self.yc) * np.tan(a) + self.rho / np.cos(a)
        assert self.xc < np.pi * m / 2, "rack tip is pointed"
        self.u_root, self.u_form = self.xc, self.xc - self.yc / np.tan(a)
        self.r_form = self._troch_polar(np.array([self.u_form]))[0][0]
        self.xi_tip = self.xi(self.r_tip)
        self.xi_form = self.xi(self.r_form)

    def xi(self, r):
        """Roll angle at radius r."""
        return np.sqrt((r / self.r_base) ** 2 - 1)

    def arc(self, xi):
        """Arc length along the involute from the base circle."""
        return self.r_base * np.asarray(xi) ** 2 / 2

    def xi_of_arc(self, s):
        return np.sqrt(2 * np.asarray(s) / self.r_base)

    def flank(self, xi):
        """Point (n, 2) of the involute."""
        xi = np.atleast_1d(xi)
        r = self.r_base * np.sqrt(1 + xi**2)
        psi = self.half_base - (xi - np.arctan(xi))
        return np.column_stack([r * np.cos(psi), r * np.sin(psi)])

    def inward_normal(self, xi):
        """Unit normal into the material; it is tangent to the base circle."""
        # the line of action touches the base circle at polar angle half_base - xi (positive side)
        t = self.half_base - np.atleast_1d(xi)
        return np.column_stack([np.sin(t), -np.cos(t)])

    def towards_tip(self, xi):
        """Unit tangent of the flank towards the tip, at right angles to the normal."""
        t = self.half_base - np.atleast_1d(xi)
        return np.column_stack([np.cos(t), np.sin(t)])

    def _troch_polar(self, u):
        d = np.stack([self.xc - u, np.full_like(u, self.yc)])
        p = np.stack([np.full_like(u, self.xc), np.full_like(u, self.yc)]) + self.rho * d / np.hypot(*d)
        x, y = p[0] - u, self.r + p[1]
        return np.hypot(x, y), np.arctan2(x, y) + u / self.r

    def fillet(self, u):
        """Point (n, 2) of the trochoid, u from u_form (meets the involute) to u_root (meets the root circle)."""
        r, psi = self._troch_polar(np.atleast_1d(np.asarray(u, float)))
        return np.column_stack([r * np.cos(psi), r * np.sin(psi)])

    def fillet_dense(self, n=4001):
        """Fillet polyline from the involute to the root circle: points, arc length, tangent angle to the centre line."""
        t = np.linspace(0, 1, n)
        u = self.u_form + (self.u_root - self.u_form) * (1 - (1 - t) ** 2)  # finer towards the root circle
        p = self.fillet(u)
        s = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(p, axis=0).T))])
        g = np.gradient(p, s, axis=0)
        return p, s, np.arctan2(g[:, 1], -g[:, 0])

    def check(self):
        a = 150.0
        aw = np.arccos(2 * self.r_base / a)
        path = 2 * np.sqrt(self.r_tip**2 - self.r_base**2) - a * np.sin(aw)
        inv = lambda t: np.tan(t) - t
        thick = 2 * 75.0 * (np.pi / (2 * self.z) + 2 * self.x * np.tan(self.alpha) / self.z + inv(self.alpha) - inv(aw))
        f, s, th = self.fillet_dense()
        return dict(alpha_w_deg=np.rad2deg(aw), r_tip=self.r_tip, r_root=self.r_root, r_form=self.r_form, r_base=self.r_base,
                    contact_ratio=path / (2 * np.pi * self.r_base / self.z), backlash=2 * (np.pi * 150 / self.z / 2 - thick),
                    join_mm=float(np.hypot(*(self.flank(self.xi_form)[0] - f[0]))), fillet_len=s[-1],
                    tangent_deg=(np.rad2deg(th[0]), np.rad2deg(th[-1])))
