"""Plane-strain near field of a contact line: what the 3D mesh gets wrong, by comparison with a finely graded mesh.

kappa(s) = c0(s) - w_h(s) in mm per (N/mm):
  c0   deflection of the contact centre along the inward normal under a Hertz pressure of half width A0 (truncated at the
       tip edge, resultant kept), fine triangles graded to the load;
  w_h  deflection under the unit line load, at the load, on the cross-section of the 3D mesh.
Both: one pitch outside r_inner, cut faces fixed, plane strain.
"""

import gmsh
import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.sparse.linalg import splu

from fe import LAMBDA, MU, plane_strain_stiffness, quad1d
from section import Section, section_parameters

A0 = 0.05  # mm, reference half width


def boundary_pieces(t, r_inner, xi_split):
    """Closed outline of one pitch: list of (points) polylines counter-clockwise; the right flank is split at xi_split."""
    hp = t.pitch_angle / 2
    flip = np.array([1.0, -1.0])
    fil, _, _ = t.fillet_dense(401)
    fil = fil[::4]
    def flank(x0, x1, n=60):
        return t.flank(np.linspace(x0, x1, n))
    pc = np.arctan2(fil[-1, 1], fil[-1, 0])
    arc = lambda r, a, b, n=12: np.column_stack([r * np.cos(np.linspace(a, b, n)), r * np.sin(np.linspace(a, b, n))])
    pt = np.arctan2(*t.flank(t.xi_tip)[0][::-1])
    low_in, high_in = arc(r_inner, -hp, -hp, 1)[0], arc(r_inner, hp, hp, 1)[0]
    low_out, high_out = low_in * t.r_root / r_inner, high_in * t.r_root / r_inner
    right = [flank(t.xi_form, xi_split) * flip] + ([flank(xi_split, t.xi_tip) * flip] if xi_split < t.xi_tip - 1e-9 else [])
    return ([np.array([low_in, low_out]), arc(t.r_root, -hp, -pc, 5), fil[::-1] * flip] + right
            + [arc(t.r_tip, -pt, pt), flank(t.xi_tip, t.xi_form), fil, arc(t.r_root, pc, hp, 5),
               np.array([high_out, high_in]), arc(r_inner, hp, -hp, 20)])


def fine_mesh(t, r_inner, xi, h0):
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    pieces = boundary_pieces(t, r_inner, xi)
    first, last, lines = None, None, []
    P = t.flank(xi)[0] * [1, -1]
    for p in pieces:
        ids = [last if last is not None else gmsh.model.geo.addPoint(*p[0], 0)]
        first = first or ids[0]
        for q in p[1:-1]:
            ids.append(gmsh.model.geo.addPoint(*q, 0))
        ids.append(first if p is pieces[-1] else gmsh.model.geo.addPoint(*p[-1], 0))
        last = ids[-1]
        lines.append(gmsh.model.geo.addLine(*ids) if len(ids) == 2 else gmsh.model.geo.addSpline(ids))
    gmsh.model.geo.addPlaneSurface([gmsh.model.geo.addCurveLoop(lines)])
    gmsh.model.geo.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
    gmsh.option.setNumber("Mesh.MeshSizeFromPoints", 0)
    f = gmsh.model.mesh.field.add("MathEval")
    d = f"sqrt((x-({P[0]}))^2+(y-({P[1]}))^2)"
    gmsh.model.mesh.field.setString(f, "F", f"{h0} + 0.12*{d} - 0.12*{d}*{d}/({d}+6.0)")
    gmsh.model.mesh.field.setAsBackgroundMesh(f)
    gmsh.model.mesh.generate(2)
    tag, x, _ = gmsh.model.mesh.getNodes()
    order = np.argsort(tag)
    x = x.reshape(-1, 3)[order, :2]
    idx = np.zeros(int(tag.max()) + 1, int)
    idx[tag[order].astype(int)] = np.arange(len(tag))
    _, _, en = gmsh.model.mesh.getElements(2)
    tri = idx[en[0].astype(int)].reshape(-1, 3)
    gmsh.finalize()
    used = np.unique(tri)
    new = np.full(len(x), -1)
    new[used] = np.arange(len(used))
    return x[used], new[tri]


def c0(t, r_inner, xi, h0=A0 / 8):
    from skfem import Basis, BilinearForm, ElementTriP2, ElementVector, FacetBasis, LinearForm, MeshTri
    from skfem.helpers import ddot, sym_grad, trace, eye
    x, tri = fine_mesh(t, r_inner, xi, h0)
    m = MeshTri(np.ascontiguousarray(x.T), np.ascontiguousarray(tri.T))
    P = t.flank(xi)[0] * [1, -1]
    n = t.inward_normal(xi)[0] * [1, -1]
    tang = np.array([-n[1], n[0]])
    el = ElementVector(ElementTriP2())
    B = Basis(m, el, intorder=4)

    @BilinearForm
    def stiff(u, v, w):
        e = sym_grad(u)
        return ddot(2 * MU * e + eye(LAMBDA * trace(e), 2), sym_grad(v))

    # flank edges near the load
    bf = m.boundary_facets()
    mid = m.p[:, m.facets[:, bf]].mean(axis=1)
    d = mid - P[:, None]
    near = bf[(np.hypot(*d) < 2 * A0) & (np.abs(n @ d) < 0.3 * np.hypot(*d) + 1e-9) & (np.hypot(*mid) < t.r_tip - 1e-5)]
    FB = FacetBasis(m, el, facets=near, intorder=12)

    @LinearForm
    def load(v, w):
        s = (tang[0] * (w.x[0] - P[0]) + tang[1] * (w.x[1] - P[1])) / A0
        p = 2 / (np.pi * A0) * np.sqrt(np.maximum(1 - s**2, 0))
        return p * (n[0] * v[0] + n[1] * v[1])

    K, f = stiff.assemble(B).tocsc(), load.assemble(FB)
    total = (n[0] * f[B.nodal_dofs[0]].sum() + n[1] * f[B.nodal_dofs[1]].sum()
             + n[0] * f[B.facet_dofs[0]].sum() + n[1] * f[B.facet_dofs[1]].sum())
    r, psi = np.hypot(*B.doflocs), np.arctan2(B.doflocs[1], B.doflocs[0])
    fixed = (np.abs(np.abs(psi) - t.pitch_angle / 2) < 1e-6) | (r < r_inner + 2e-3)
    free = np.flatnonzero(~fixed)
    u = np.zeros(len(f))
    u[free] = splu(K[free][:, free], permc_spec="MMD_AT_PLUS_A", options=dict(SymmetricMode=True), diag_pivot_thresh=0.0).solve(f[free] / total)
    i = np.argmin(np.hypot(m.p[0] - P[0], m.p[1] - P[1]))
    assert np.hypot(m.p[0, i] - P[0], m.p[1, i] - P[1]) < 1e-9
    return n @ u[B.nodal_dofs[:, i]], total, len(free)


class NearField:
    def __init__(self, tooth, r_inner, mesh, stations, c0_values):
        self.tooth = tooth
        sec = self.sec = Section(tooth, r_inner, [], **section_parameters(mesh))
        K = plane_strain_stiffness(sec.nodes, sec.quads).tocsc()
        fixed = np.unique(np.concatenate([sec.side["low"], sec.side["high"], sec.inner_arc]))
        mask = np.ones((len(sec.nodes), 2), bool)
        mask[fixed] = False
        free = np.flatnonzero(mask.ravel())
        fl = (2 * sec.flank["right"][:, None] + np.arange(2)).ravel()
        R = np.zeros((K.shape[0], len(fl)))
        R[fl, np.arange(len(fl))] = 1
        X = np.zeros_like(R)
        X[free] = splu(K[free][:, free]).solve(R[free])
        self.C2 = X[fl]
        # c0 varies like a logarithm of the distance from the tip edge: interpolate in that variable
        self.var = lambda xi: np.log(tooth.arc(tooth.xi_tip) - tooth.arc(xi) + 0.05)
        o = np.argsort(self.var(stations))
        self.c0 = PchipInterpolator(self.var(stations)[o], np.asarray(c0_values)[o])

    def w_h(self, xi):
        arc = self.sec.flank_arc
        ne = (len(arc) - 1) // 2
        s = (arc[0] - self.tooth.arc(xi)) / (arc[0] - arc[-1]) * ne
        e = int(np.clip(np.floor(s), 0, ne - 1))
        n, _ = quad1d(2 * (s - e) - 1)
        col = np.zeros((2 * ne + 1, 2))
        col[2 * e : 2 * e + 3] = np.outer(n, self.tooth.inward_normal(xi)[0] * [1, -1])
        return col.ravel() @ self.C2 @ col.ravel()

    def kappa(self, xi):
        return float(self.c0(self.var(xi))) - self.w_h(xi)


def stations(t, xi_min, n=22):
    d_max = t.arc(t.xi_tip) - t.arc(xi_min)
    d = np.exp(np.linspace(np.log(0.05), np.log(d_max + 0.05), n)) - 0.05
    d[0] = 0
    return t.xi_of_arc(t.arc(t.xi_tip) - d)
