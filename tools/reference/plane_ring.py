"""Deflection and root strain of a ring gear under a Hertz pressure, whole ring in plane strain, on a mesh graded to the load.

z 60, m 3 mm, x 0, 20 deg, addendum 0.8, cut by a pinion cutter of 24 teeth (addendum 1.25, tip radius 0.25 modules); the rim is 1.5 and 6
modules thick and held over its whole outside; E 206 GPa, nu 0.3; 100 N/mm on the right flank of one tooth. Read are the displacement of
the load's centre along the normal, that of the same place on the teeth before and after, and the mean strain along 0.4 mm of the loaded
side's fillet about its 45 deg tangent. The fillet is the curve beside the rolling centre of the cutter's rounding, by its numerical normal.
Quadratic triangles (scikit-fem); a second mesh with all sizes doubled gives the error estimate.

    python plane_ring.py ../../reference/plane_ring
"""

import sys

import numpy as np
from plane_gear import LOAD
from plane_mesh import FLIP, PlaneBody, arc, triangles, turned, write_table
from scipy.optimize import brentq
from skfem import FacetBasis, LinearForm
from skfem.helpers import sym_grad

RADII = [88.4, 90.0, 91.8]  # mm
OUTSIDE = {"thin": 98.25, "thick": 111.75}  # outer radius, mm
HALF_WIDTH = 0.06  # mm
GAUGE = 0.4  # mm


class Ring:
    """One tooth of the ring, centred on the x axis, its side of positive polar angle."""

    def __init__(self, z=60, m=3.0, addendum=0.8, cutter=24, cutter_addendum=1.25, rho=0.25):
        a = np.deg2rad(20.0)
        inv = np.tan(a) - a
        self.z, self.pitch_angle = z, 2 * np.pi / z
        self.r, self.r_base, self.r_tip = m * z / 2, m * z / 2 * np.cos(a), m * (z / 2 - addendum)
        self.half_base = np.pi / (2 * z) - inv
        self.rho = rho * m
        base = m * cutter / 2 * np.cos(a)
        self.centre = m * (cutter / 2 + cutter_addendum) - self.rho
        half = np.pi / (2 * cutter) + inv

        def beside(gamma):  # distance of the rounding's centre from the cutter's involute, less the rounding
            return np.sqrt(self.centre**2 - base**2) - base * (half - gamma + np.arccos(base / self.centre)) + self.rho

        self.gamma = brentq(beside, -0.1, 0.1, xtol=1e-15)
        self.axes, self.ratio = m * (z - cutter) / 2, z / cutter
        self.r_root = self.axes + self.centre + self.rho
        deepest = -self.gamma / self.ratio

        def lever(turn):  # of the fillet's normal about the ring's axis, less that of the involute
            p, n = self.curve(np.array([turn]))
            return abs(p[0, 0] * n[0, 1] - p[0, 1] * n[0, 0]) - self.r_base

        turns = np.linspace(deepest, deepest + 0.6 * np.pi / z * self.ratio, 400)
        lever_at = [lever(turn) for turn in turns]
        first = next(k for k in range(len(turns)) if lever_at[k] > 0)
        self.turns = deepest, brentq(lever, turns[first - 1], turns[first], xtol=1e-15)
        self.xi_form, self.xi_tip = self.xi(np.hypot(*self.curve(np.array(self.turns[1:]))[0][0])), self.xi(self.r_tip)

    def curve(self, turn):
        """Points cut while the line of centres stands at an angle from the middle of the space, and normals."""

        def path(b):
            space = np.pi / self.z
            at = lambda r, angle: np.column_stack([r * np.cos(angle), r * np.sin(angle)])
            return at(self.axes, space + b) + at(self.centre, space + b * (1 - self.ratio) - self.gamma)

        step = 1e-6
        along = path(turn + step) - path(turn - step)
        n = np.column_stack([-along[:, 1], along[:, 0]]) / np.hypot(*along.T)[:, None]
        c = path(turn)
        n *= np.sign((n * c).sum(axis=1))[:, None]
        return c + self.rho * n, n

    def fillet(self, n):
        """Points from the involute to the root circle."""
        p = self.curve(np.linspace(self.turns[1], self.turns[0], n))[0]
        return p

    def xi(self, r):
        return np.sqrt((r / self.r_base) ** 2 - 1)

    def flank(self, xi):
        xi = np.atleast_1d(xi)
        psi = self.half_base + xi - np.arctan(xi)
        r = self.r_base * np.hypot(1, xi)
        return np.column_stack([r * np.cos(psi), r * np.sin(psi)])

    def inward_normal(self, xi):
        t = self.half_base + xi
        return np.array([np.sin(t), -np.cos(t)])


def gauge_ends(points):
    """Numbers of the fillet's points, finely spaced, between which the gauge lies."""
    s = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    g = np.gradient(points, s, axis=0)
    tangent = np.arctan2(np.abs(g[:, 1]), np.abs(g[:, 0]))
    middle = s[np.argmin(np.abs(tangent - np.pi / 4))]
    ends = [int(np.argmin(np.abs(s - middle - d))) for d in (-GAUGE / 2, GAUGE / 2)]
    assert 0 < ends[0] < ends[1] < len(s) - 1, ends
    return ends


def pieces_of(t, splits, gauge=False):
    """Outline of a pitch, counter-clockwise; nodes at these roll angles, falling, of its right flank, and at the ends of the gauge."""
    hp = t.pitch_angle / 2
    dense = t.fillet(4001)
    ends = [0] + (gauge_ends(dense) if gauge else []) + [4000]
    thin = lambda p: np.vstack([p[:-1][:: max(1, len(p) // 40)], p[-1:]])
    fillet = [thin(dense[a : b + 1]) for a, b in zip(ends, ends[1:])]  # from the involute to the root
    right_fillet = [p[::-1] * FLIP for p in fillet[::-1]]
    cuts = [t.xi_form, *splits, t.xi_tip]
    right = [t.flank(np.linspace(a, b, 30)) * FLIP for a, b in zip(cuts, cuts[1:])]
    at_root, at_tip = (np.arctan2(p[1], p[0]) for p in (dense[-1], t.flank(t.xi_tip)[0]))
    return ([arc(t.r_root, -hp, -at_root, 4)] + right_fillet + right + [arc(t.r_tip, -at_tip, at_tip, 8),
            t.flank(np.linspace(t.xi_tip, t.xi_form, 40))] + fillet + [arc(t.r_root, at_root, hp, 4)])


def mesh(t, outside, fineness):
    splits = [t.xi(r) for r in RADII[::-1]]
    own, other = pieces_of(t, splits, True), pieces_of(t, splits)
    pieces = [turned(p, t.pitch_angle * k) for k in range(t.z) for p in (other if k else own)]
    size = f"(0.3 + 0.12*max(sqrt((x-{t.r})^2+y^2)-14.0, 0))"
    for r in RADII:
        p = t.flank(t.xi(r))[0] * FLIP
        size = f"min({size}, ({HALF_WIDTH / 8} + 0.1*sqrt((x-({p[0]}))^2+(y-({p[1]}))^2)))"
    return triangles(pieces, outside, f"min({size}, 2.5)/{fineness}")


def readings(t, outside, fineness):
    """Per radius: own deflection, that of tooth 1 and of the last tooth (mm), root strain; and degrees of freedom."""
    body = PlaneBody(mesh(t, outside, fineness), outside)
    m, boundary, middles = body.mesh, body.boundary, body.middles
    loads, places = [], []
    for r in RADII:
        centre, normal = t.flank(t.xi(r))[0] * FLIP, t.inward_normal(t.xi(r)) * FLIP
        loads.append(LOAD * body.hertz(centre, normal, HALF_WIDTH))
        found = []
        for tooth in (0, 1, -1):
            p, n = turned(centre[None], t.pitch_angle * tooth)[0], turned(normal[None], t.pitch_angle * tooth)[0]
            found.append((body.at(p), n))
        places.append(found)
    # the gauge: boundary edges of the right fillet between its ends
    dense = t.fillet(4001)
    a, b = (dense[i] * FLIP for i in gauge_ends(dense))
    radii = sorted((np.hypot(*a), np.hypot(*b)))
    r, angle = np.hypot(*middles), np.arctan2(middles[1], middles[0])
    on = boundary[(r > radii[0]) & (r < radii[1]) & (angle < 0) & (angle > -t.pitch_angle / 2)]
    facets = FacetBasis(m, body.element, facets=on, intorder=6)

    @LinearForm
    def gauge(v, w):
        e = sym_grad(v)
        tx, ty = -w.n[1], w.n[0]
        return tx * tx * e[0][0] + 2 * tx * ty * e[0][1] + ty * ty * e[1][1]

    ends = m.p[:, m.facets[:, on]]
    length = np.hypot(*(ends[:, 0] - ends[:, 1])).sum()
    assert abs(length / GAUGE - 1) < 5e-3, length
    g = gauge.assemble(facets) / length
    u = body.solve(loads)
    rows = [[n @ u[dofs, j] for dofs, n in found] + [g @ u[:, j]] for j, found in enumerate(places)]
    return np.array(rows), len(body.free)


def main(folder):
    t = Ring()
    rows, worst, dofs = [], np.zeros(4), 0
    for name, outside in OUTSIDE.items():
        coarse, _ = readings(t, outside, 1.25)
        fine, n = readings(t, outside, 2.5)
        change = np.abs(coarse - fine).max(axis=0) / np.abs(fine).max(axis=0)
        worst, dofs = np.maximum(worst, change), max(dofs, n)
        print(name, fine, "change", change, n, flush=True)
        rows += [(2 * outside, r, *values) for r, values in zip(RADII, fine)]
    columns = "outer_diameter_mm,radius_mm,own_um,tooth_after_um,tooth_before_um,root_strain_um_per_m"
    table = [[f"{outer:.2f}", f"{radius:.1f}", *(f"{v * 1e3:.6f}" for v in teeth), f"{strain * 1e6:.4f}"] for outer, radius, *teeth, strain in rows]
    write_table(folder, columns, table, RECORD.format(dofs=dofs, own=worst[0], other=worst[1:3].max(), strain=worst[3]))


RECORD = '''title = "Flank deflection and root strain of a ring gear in plane strain, two rims, three radii"
kind = "computed"
source = "tools/reference/plane_ring.py: own tooth geometry and mesh (gmsh), finite elements by scikit-fem; not measured"

[gear]
teeth = -60
module_mm = 3.0
pressure_angle_deg = 20.0
profile_shift = 0.0
addendum = 0.8
cutter_teeth = 24
cutter_addendum = 1.25
cutter_tip_radius = 0.25
young_GPa = 206.0
poisson = 0.3

[load]
line_load_N_per_mm = 100.0
half_width_mm = 0.06
distribution = "Hertz pressure on the right flank of tooth 0, centred at the radius, along the normal there"

[columns]
outer_diameter_mm = "outside of the rim, held all round"
radius_mm = "radius of the load's centre"
own_um = "displacement of the load's centre along the inward normal"
tooth_after_um = "that of the same place on the next tooth, counter-clockwise"
tooth_before_um = "and on the one before"
root_strain_um_per_m = "mean strain along 0.4 mm of the right fillet of tooth 0 about its 45 deg tangent"

[method]
state = "plane strain, whole ring"
elements = "quadratic triangles with straight edges, at most {dofs} degrees of freedom"
error_estimate = "all element sizes doubled change own deflections by {own:.1e}, others by {other:.1e} of the largest, strains by {strain:.1e}"
'''

if __name__ == "__main__":
    main(sys.argv[1])
