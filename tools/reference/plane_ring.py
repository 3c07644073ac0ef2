"""Deflection and root strain of a ring gear under a Hertz pressure, whole ring in plane strain, on a mesh graded to the load.

z 60, m 3 mm, x 0, 20 deg, addendum 0.8, cut by a pinion cutter of 24 teeth (addendum 1.25, tip radius 0.25 modules); the rim is 1.5 and 6
modules thick and held over its whole outside; E 206 GPa, nu 0.3; 100 N/mm on the right flank of one tooth. Read are the displacement of
the load's centre along the normal, that of the same place on the teeth before and after, and the mean strain along 0.4 mm of the loaded
side's fillet about its 45 deg tangent. The fillet is the curve beside the rolling centre of the cutter's rounding, by its numerical normal.
Quadratic triangles (scikit-fem); a second mesh with all sizes doubled gives the error estimate.

    python plane_ring.py ../../reference/plane_ring
"""

import sys
from pathlib import Path

import gmsh
import numpy as np
from plane_gear import FLIP, LOAD, stiffness, turned
from scipy.optimize import brentq
from scipy.sparse.linalg import splu
from skfem import Basis, ElementTriP2, ElementVector, FacetBasis, LinearForm, MeshTri
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


def pieces_of(t, detailed):
    hp = t.pitch_angle / 2
    arc = lambda r, a, b, n: np.column_stack([r * np.cos(np.linspace(a, b, n)), r * np.sin(np.linspace(a, b, n))])
    dense = t.fillet(4001)
    ends = [0] + (gauge_ends(dense) if detailed else []) + [4000]
    thin = lambda p: np.vstack([p[:-1][:: max(1, len(p) // 40)], p[-1:]])
    fillet = [thin(dense[a : b + 1]) for a, b in zip(ends, ends[1:])]  # from the involute to the root
    right_fillet = [p[::-1] * FLIP for p in fillet[::-1]]
    cuts = [t.xi_form] + [t.xi(r) for r in RADII[::-1]] + [t.xi_tip]
    right = [t.flank(np.linspace(a, b, 30)) * FLIP for a, b in zip(cuts, cuts[1:])]
    at_root, at_tip = (np.arctan2(p[1], p[0]) for p in (dense[-1], t.flank(t.xi_tip)[0]))
    return ([arc(t.r_root, -hp, -at_root, 4)] + right_fillet + right + [arc(t.r_tip, -at_tip, at_tip, 8),
            t.flank(np.linspace(t.xi_tip, t.xi_form, 40))] + fillet + [arc(t.r_root, at_root, hp, 4)])


def mesh(t, outside, fineness):
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    geo = gmsh.model.geo
    first = last = None
    lines = []
    own, other = pieces_of(t, True), pieces_of(t, False)
    pieces = [turned(p, t.pitch_angle * k) for k in range(t.z) for p in (other if k else own)]
    for i, piece in enumerate(pieces):
        ids = [last or geo.addPoint(*piece[0], 0)]
        first = first or ids[0]
        ids += [geo.addPoint(*p, 0) for p in piece[1:-1]]
        ids.append(first if i + 1 == len(pieces) else geo.addPoint(*piece[-1], 0))
        last = ids[-1]
        lines.append(geo.addSpline(ids))
    centre = geo.addPoint(0, 0, 0)
    quarter = [geo.addPoint(outside * np.cos(a), outside * np.sin(a), 0) for a in np.pi / 2 * np.arange(4)]
    circle = [geo.addCircleArc(quarter[k], centre, quarter[(k + 1) % 4]) for k in range(4)]
    geo.addPlaneSurface([geo.addCurveLoop(circle), geo.addCurveLoop(lines)])
    geo.synchronize()
    for option in ("MeshSizeExtendFromBoundary", "MeshSizeFromPoints"):
        gmsh.option.setNumber("Mesh." + option, 0)
    gmsh.option.setNumber("Mesh.MeshSizeFactor", 1.0)
    near = []
    for r in RADII:
        p = t.flank(t.xi(r))[0] * FLIP
        near.append(f"({HALF_WIDTH / 8} + 0.1*sqrt((x-({p[0]}))^2+(y-({p[1]}))^2))")
    far = f"(0.3 + 0.12*max(sqrt((x-{t.r})^2+y^2)-14.0, 0))"
    size = far
    for expression in near:
        size = f"min({size}, {expression})"
    field = gmsh.model.mesh.field.add("MathEval")
    gmsh.model.mesh.field.setString(field, "F", f"min({size}, 2.5)/{fineness}")
    gmsh.model.mesh.field.setAsBackgroundMesh(field)
    gmsh.model.mesh.generate(2)
    tag, x, _ = gmsh.model.mesh.getNodes()
    place = np.zeros(int(tag.max()) + 1, int)
    place[tag.astype(int)] = np.arange(len(tag))
    tri = place[gmsh.model.mesh.getElements(2)[2][0].astype(int)].reshape(-1, 3)
    gmsh.finalize()
    used, tri = np.unique(tri, return_inverse=True)
    return MeshTri(np.ascontiguousarray(x.reshape(-1, 3)[used, :2].T), np.ascontiguousarray(tri.reshape(-1, 3).T))


def readings(t, outside, fineness):
    """Per radius: own deflection, that of tooth 1 and of the last tooth (mm), root strain; and degrees of freedom."""
    m = mesh(t, outside, fineness)
    element = ElementVector(ElementTriP2())
    basis = Basis(m, element, intorder=4)
    boundary = m.boundary_facets()
    # edges on the outside lie a little inside its circle, their middles too
    free = np.setdiff1d(np.arange(basis.N), basis.get_dofs(lambda x: np.hypot(*x) > outside - 0.012).all())
    k = stiffness.assemble(basis).tocsc()
    middles = m.p[:, m.facets[:, boundary]].mean(axis=1)
    loads, places = [], []
    for r in RADII:
        centre, normal = t.flank(t.xi(r))[0] * FLIP, t.inward_normal(t.xi(r)) * FLIP
        tangent = np.array([-normal[1], normal[0]])
        away = middles - centre[:, None]
        near = boundary[(np.hypot(*away) < 1.5 * HALF_WIDTH) & (np.abs(normal @ away) < 0.3 * np.hypot(*away) + 1e-9)]

        @LinearForm
        def pressure(v, w):
            s = (tangent[0] * (w.x[0] - centre[0]) + tangent[1] * (w.x[1] - centre[1])) / HALF_WIDTH
            p = 2 / (np.pi * HALF_WIDTH) * np.sqrt(np.maximum(1 - s**2, 0))
            return p * (normal[0] * v[0] + normal[1] * v[1])

        f = pressure.assemble(FacetBasis(m, element, facets=near, intorder=12))
        total = sum(normal[i] * (f[basis.nodal_dofs[i]].sum() + f[basis.facet_dofs[i]].sum()) for i in range(2))
        assert abs(total - 1) < 5e-3, total
        loads.append(LOAD * f / total)
        found = []
        for tooth in (0, 1, -1):
            p, n = turned(centre[None], t.pitch_angle * tooth)[0], turned(normal[None], t.pitch_angle * tooth)[0]
            i = np.argmin(np.hypot(*(m.p - p[:, None])))
            assert np.hypot(*(m.p[:, i] - p)) < 1e-9
            found.append((basis.nodal_dofs[:, i], n))
        places.append(found)
    # the gauge: boundary edges of the right fillet between its ends
    dense = t.fillet(4001)
    a, b = (dense[i] * FLIP for i in gauge_ends(dense))
    radii = sorted((np.hypot(*a), np.hypot(*b)))
    r, angle = np.hypot(*middles), np.arctan2(middles[1], middles[0])
    on = boundary[(r > radii[0]) & (r < radii[1]) & (angle < 0) & (angle > -t.pitch_angle / 2)]
    facets = FacetBasis(m, element, facets=on, intorder=6)

    @LinearForm
    def gauge(v, w):
        e = sym_grad(v)
        tx, ty = -w.n[1], w.n[0]
        return tx * tx * e[0][0] + 2 * tx * ty * e[0][1] + ty * ty * e[1][1]

    ends = m.p[:, m.facets[:, on]]
    length = np.hypot(*(ends[:, 0] - ends[:, 1])).sum()
    assert abs(length / GAUGE - 1) < 5e-3, length
    g = gauge.assemble(facets) / length
    u = np.zeros((k.shape[0], len(loads)))
    options = dict(SymmetricMode=True)
    u[free] = splu(k[free][:, free], permc_spec="MMD_AT_PLUS_A", options=options, diag_pivot_thresh=0.0).solve(
        np.column_stack(loads)[free])
    rows = [[n @ u[dofs, j] for dofs, n in found] + [g @ u[:, j]] for j, found in enumerate(places)]
    return np.array(rows), len(free)


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
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "data.csv", "w") as f:
        f.write("outer_diameter_mm,radius_mm,own_um,tooth_after_um,tooth_before_um,root_strain_um_per_m\n")
        for outer, radius, own, after, before, strain in rows:
            f.write(f"{outer:.2f},{radius:.1f},{own * 1e3:.6f},{after * 1e3:.6f},{before * 1e3:.6f},{strain * 1e6:.4f}\n")
    (folder / "record.toml").write_text(RECORD.format(dofs=dofs, own=worst[0], other=worst[1:3].max(), strain=worst[3]))


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
