"""A whole gear in plane strain on quadratic triangles (gmsh, scikit-fem): mesh between its outline and a circle, Hertz pressures, readings. N, mm."""

from pathlib import Path

import gmsh
import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementTriP2, ElementVector, FacetBasis, LinearForm, MeshTri
from skfem.helpers import ddot, eye, sym_grad, trace

E_MPA, NU = 206e3, 0.3
LAMBDA, MU = E_MPA * NU / ((1 + NU) * (1 - 2 * NU)), E_MPA / (2 * (1 + NU))
FLIP = np.array([1.0, -1.0])


def turned(points, angle):
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


def arc(r, a, b, n):
    return np.column_stack([r * np.cos(np.linspace(a, b, n)), r * np.sin(np.linspace(a, b, n))])


def triangles(pieces, circle, size, nodes=()):
    """Mesh between a closed outline, pieces one behind the other, and a circle, with nodes at these angles of it; `size`: gmsh's expression of the edge
    length in x and y."""
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    geo = gmsh.model.geo
    first = last = None
    lines = []
    for i, piece in enumerate(pieces):
        ids = [last or geo.addPoint(*piece[0], 0)]
        first = first or ids[0]
        ids += [geo.addPoint(*p, 0) for p in piece[1:-1]]
        ids.append(first if i + 1 == len(pieces) else geo.addPoint(*piece[-1], 0))
        last = ids[-1]
        lines.append(geo.addSpline(ids))
    centre = geo.addPoint(0, 0, 0)
    angles = np.unique(np.round(np.concatenate([np.pi / 2 * np.arange(4), np.asarray(nodes) % (2 * np.pi)]), 12))
    round_it = [geo.addPoint(circle * np.cos(a), circle * np.sin(a), 0) for a in angles]
    loops = [lines, [geo.addCircleArc(a, centre, b) for a, b in zip(round_it, round_it[1:] + round_it[:1])]]
    if circle > np.hypot(*pieces[0][0]):
        loops.reverse()
    geo.addPlaneSurface([geo.addCurveLoop(loop) for loop in loops])
    geo.synchronize()
    for option in ("MeshSizeExtendFromBoundary", "MeshSizeFromPoints"):
        gmsh.option.setNumber("Mesh." + option, 0)
    gmsh.option.setNumber("Mesh.MeshSizeFactor", 1.0)
    field = gmsh.model.mesh.field.add("MathEval")
    gmsh.model.mesh.field.setString(field, "F", size)
    gmsh.model.mesh.field.setAsBackgroundMesh(field)
    gmsh.model.mesh.generate(2)
    tag, x, _ = gmsh.model.mesh.getNodes()
    place = np.zeros(int(tag.max()) + 1, int)
    place[tag.astype(int)] = np.arange(len(tag))
    tri = place[gmsh.model.mesh.getElements(2)[2][0].astype(int)].reshape(-1, 3)
    gmsh.finalize()
    used, tri = np.unique(tri, return_inverse=True)
    return MeshTri(np.ascontiguousarray(x.reshape(-1, 3)[used, :2].T), np.ascontiguousarray(tri.reshape(-1, 3).T))


@BilinearForm
def stiffness(u, v, w):
    strain = sym_grad(u)
    return ddot(2 * MU * strain + eye(LAMBDA * trace(strain), 2), sym_grad(v))


class PlaneBody:
    """A mesh that is held on its circle of radius `held`, all round or where `holds` is true of an edge's polar angle; where it `slides`, it is free along the
    circle but for one node, which keeps it from turning: loads without moment leave no force there. Where it `floats`, the circle is free but for what keeps the
    body from moving, at its nodes at 0 and 180 degrees: loads in balance leave no force there."""

    def __init__(self, mesh, held, holds=lambda angle: angle == angle, slides=False, floats=False):
        self.mesh, self.element = mesh, ElementVector(ElementTriP2())
        self.basis = Basis(mesh, self.element, intorder=4)
        self.boundary = mesh.boundary_facets()
        self.middles = mesh.p[:, mesh.facets[:, self.boundary]].mean(axis=1)
        ends = np.hypot(*mesh.p)[mesh.facets[:, self.boundary]]
        on = self.boundary[(np.abs(ends - held) < 1e-6 * held).all(axis=0) & holds(np.arctan2(self.middles[1], self.middles[0]))]
        fixed = self.basis.get_dofs(on).all()
        if floats:
            front, back = self.at(np.array([held, 0.0])), self.at(np.array([-held, 0.0]))
            fixed = np.array([*front, back[1]])
        self.free = np.setdiff1d(np.arange(self.basis.N), fixed)
        rows, columns, values = self.free, np.arange(len(self.free)), np.ones(len(self.free))
        if slides:
            nodes = np.unique(mesh.facets[:, on])
            x, y = np.hstack([mesh.p[:, nodes], mesh.p[:, mesh.facets[:, on]].mean(axis=1)])[:, 1:]
            dofs = np.hstack([self.basis.nodal_dofs[:, nodes], self.basis.facet_dofs[:, on]])[:, 1:]
            along = len(self.free) + np.arange(len(x))
            rows, columns = np.concatenate([rows, *dofs]), np.concatenate([columns, along, along])
            values = np.concatenate([values, -y / np.hypot(x, y), x / np.hypot(x, y)])
        self.moves = coo_array((values, (rows, columns)), shape=(self.basis.N, columns.max() + 1)).tocsc()
        k = (self.moves.T @ stiffness.assemble(self.basis) @ self.moves).tocsc()
        options = dict(SymmetricMode=True)
        self.factor = splu(k, permc_spec="MMD_AT_PLUS_A", options=options, diag_pivot_thresh=0.0)

    def hertz(self, centre, normal, half_width):
        """Nodal forces of 1 N/mm along the normal, spread as a Hertz pressure."""
        tangent = np.array([-normal[1], normal[0]])
        away = self.middles - centre[:, None]
        distance = np.hypot(*away)
        near = self.boundary[(distance < 1.5 * half_width) & (np.abs(normal @ away) < 0.3 * distance + 1e-9)]

        @LinearForm
        def pressure(v, w):
            s = (tangent[0] * (w.x[0] - centre[0]) + tangent[1] * (w.x[1] - centre[1])) / half_width
            p = 2 / (np.pi * half_width) * np.sqrt(np.maximum(1 - s**2, 0))
            return p * (normal[0] * v[0] + normal[1] * v[1])

        f = pressure.assemble(FacetBasis(self.mesh, self.element, facets=near, intorder=12))
        basis = self.basis
        total = sum(normal[i] * (f[basis.nodal_dofs[i]].sum() + f[basis.facet_dofs[i]].sum()) for i in range(2))
        assert abs(total - 1) < 5e-3, total
        return f / total

    def pad(self, circle, angle, half_angle):
        """Nodal forces of 1 N/mm away from the centre, even over an arc of the circle; nodes must stand at its ends."""
        turn = np.angle(np.exp(1j * (np.arctan2(self.middles[1], self.middles[0]) - angle)))
        on = np.hypot(*self.middles) < 1.01 * circle
        near = self.boundary[on & (np.abs(turn) < half_angle)]

        @LinearForm
        def pressure(v, w):
            r = np.hypot(w.x[0], w.x[1])
            return (w.x[0] * v[0] + w.x[1] * v[1]) / r / (2 * half_angle * circle)

        return pressure.assemble(FacetBasis(self.mesh, self.element, facets=near, intorder=6))

    def solve(self, loads):
        return self.moves @ self.factor.solve(self.moves.T @ np.column_stack(loads))

    def at(self, point):
        """Degrees of freedom of the node at a point."""
        i = np.argmin(np.hypot(*(self.mesh.p - point[:, None])))
        assert np.hypot(*(self.mesh.p[:, i] - point)) < 1e-9
        return self.basis.nodal_dofs[:, i]


def write_table(folder, columns, rows, record):
    """data.csv, its rows as lists of texts, and record.toml of a reference."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    lines = [columns, *(",".join(row) for row in rows)]
    (folder / "data.csv").write_text("\n".join(lines) + "\n")
    (folder / "record.toml").write_text(record)
