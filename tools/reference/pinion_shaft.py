"""Pinions that are one with their shafts between a clamp and a bearing: deflections of one flank and the bearing's force, in one elastic body.

x 0.2, 20 deg, addendum 1, dedendum 1.25, rack tip radius 0.38, face 30 mm; teeth, module and shafts of the case. The shaft goes on at both faces and
fills the core. The front end is clamped; the mean of the back end is held across the axis. Loads of
1 N along the normal on the right flank of one tooth, spread by hats: over the roll angle about the middle of the flank, over z about five
even stations. E 210 GPa, nu 0.3. Hexahedra with 27 nodes (scikit-fem) on the extruded section; a mesh with longer elements gives the error estimate.

    python pinion_shaft.py ../../reference/pinion_shaft usual
    python pinion_shaft.py ../../reference/pinion_shaft_slim slim
    python pinion_shaft.py ../../reference/pinion_shaft_thick thick
"""

import sys
from pathlib import Path

import gmsh
import numpy as np
import scipy.sparse as sp
from pypardiso import PyPardisoSolver
from skfem import Basis, BilinearForm, ElementHex2, ElementVector, FacetBasis, LinearForm, MeshHex
from skfem.helpers import ddot, eye, sym_grad, trace

from plane_gear import tooth_pieces, turned
from tooth import Tooth

E_MPA, NU = 210e3, 0.3
LAMBDA, MU = E_MPA * NU / ((1 + NU) * (1 - 2 * NU)), E_MPA / (2 * (1 + NU))
WIDTH = 30.0  # mm
# Teeth, module, and of the shaft at the back and the front face radius and length beyond it (mm).
# Of the coarse and the fine mesh: elements on the loaded tooth and elsewhere, layers along the face and each stub.
CASES = {
    "slim": (17, 3.0, [11.0, 12.0], [40.0, 50.0], [(1.4, 5.0, 4, 4), (1.0, 4.0, 6, 5)]),
    "usual": (17, 3.0, [16.0, 15.0], [40.0, 50.0], [(1.4, 5.0, 4, 4), (1.0, 4.0, 6, 5)]),
    "thick": (34, 2.0, [28.5, 27.0], [80.0, 100.0], [(0.95, 5.0, 4, 5), (0.7, 4.0, 6, 7)]),
}
TEETH, MODULE, SHAFT, STUB, SIZES = CASES[sys.argv[2] if len(sys.argv) > 2 else "usual"]
STATIONS = np.linspace(-WIDTH / 2, WIDTH / 2, 5)


def section(t, near, far):
    """Quads of the cross-section, elements `near` long on the loaded tooth and `far` elsewhere, with both shafts' outlines among their sides."""
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    geo = gmsh.model.geo
    first = last = None
    lines = []
    pieces = [turned(p, t.pitch_angle * k) for k in range(t.z) for p in tooth_pieces(t, None)]
    for piece in pieces:
        ids = [last or geo.addPoint(*piece[0], 0)]
        first = first or ids[0]
        ids += [geo.addPoint(*p, 0) for p in piece[1:-1]]
        ids.append(first if piece is pieces[-1] else geo.addPoint(*piece[-1], 0))
        last = ids[-1]
        lines.append(geo.addSpline(ids))
    centre = geo.addPoint(0, 0, 0)
    loops = [geo.addCurveLoop(lines)]
    for radius in sorted(SHAFT, reverse=True):
        quarter = [geo.addPoint(radius * np.cos(a), radius * np.sin(a), 0) for a in np.pi / 2 * np.arange(4)]
        loops.append(geo.addCurveLoop([geo.addCircleArc(quarter[k], centre, quarter[(k + 1) % 4]) for k in range(4)]))
    for outer, inner in zip(loops, loops[1:]):
        geo.addPlaneSurface([outer, inner])
    geo.addPlaneSurface([loops[-1]])
    geo.synchronize()
    for option in ("MeshSizeExtendFromBoundary", "MeshSizeFromPoints"):
        gmsh.option.setNumber("Mesh." + option, 0)
    field = gmsh.model.mesh.field.add("MathEval")
    axis = f"sqrt((x-{t.r})^2+y^2)"
    # Halved by the subdivision into quads.
    gmsh.model.mesh.field.setString(field, "F", f"min({2 * near} + 0.25*max({axis}-4.5, 0), {2 * far})")
    gmsh.model.mesh.field.setAsBackgroundMesh(field)
    for k, v in (("RecombineAll", 1), ("SubdivisionAlgorithm", 1), ("Algorithm", 8)):
        gmsh.option.setNumber("Mesh." + k, v)
    gmsh.model.mesh.generate(2)
    tag, x, _ = gmsh.model.mesh.getNodes()
    place = np.zeros(int(tag.max()) + 1, int)
    place[tag.astype(int)] = np.arange(len(tag))
    types, _, nodes = gmsh.model.mesh.getElements(2)
    assert list(types) == [3], types
    quads = place[nodes[0].astype(int)].reshape(-1, 4)
    gmsh.finalize()
    used, quads = np.unique(quads, return_inverse=True)
    points, quads = x.reshape(-1, 3)[used, :2], quads.reshape(-1, 4)
    corner = points[quads]
    a, b = corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1]
    over = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] < 0
    quads[over] = quads[over][:, ::-1]
    return points, quads


def body(t, near, far, layers, stub_layers):
    """Hexahedra of pinion and stubs."""
    points, quads = section(t, near, far)
    # Layers grow from the faces to the middle, and from them into the stubs.
    half = np.linspace(0, 1, layers // 2 + 1)
    inside = np.concatenate([-WIDTH / 2 * half[::-1], WIDTH / 2 * half[1:]])
    radius = np.hypot(*points[quads].transpose(2, 0, 1)).max(axis=1)
    nodes, cells, known = [], [], {}

    def node(n, z):
        key = (n, round(z, 9))
        if key not in known:
            known[key] = len(nodes)
            nodes.append([*points[n], z])
        return known[key]

    def extrude(which, planes):
        for low, high in zip(planes, planes[1:]):
            for quad in quads[which]:
                cells.append([node(n, low) for n in quad] + [node(n, high) for n in quad])

    grow = (np.expm1(1.2 * np.linspace(0, 1, stub_layers + 1))) / np.expm1(1.2)
    extrude(np.full(len(quads), True), inside)
    extrude(radius < SHAFT[0] * (1 + 1e-6), -WIDTH / 2 - STUB[0] * grow[::-1])
    extrude(radius < SHAFT[1] * (1 + 1e-6), WIDTH / 2 + STUB[1] * grow)
    # scikit-fem numbers the corners of its cube by its own rule.
    order = [0, 4, 3, 1, 7, 5, 2, 6]
    return MeshHex(np.array(nodes).T.copy(), np.array(cells)[:, order].T.copy())


@BilinearForm
def stiffness(u, v, w):
    strain = sym_grad(u)
    return ddot(2 * MU * strain + eye(LAMBDA * trace(strain), 3), sym_grad(v))


def hat(x, stations, k):
    return np.interp(x, stations, np.eye(len(stations))[k])


def answers(t, *sizes):
    """Deflections (um/N), `[load][response]`, force of the bearing on the shaft (N) `[load][x, y]`, and degrees of freedom."""
    m = body(t, *sizes)
    element = ElementVector(ElementHex2())
    basis = Basis(m, element, intorder=5)
    k = stiffness.assemble(basis).tocsc()
    boundary = m.boundary_facets()
    middle = m.p[:, m.facets[:, boundary]].mean(axis=1)
    rolls = np.linspace(t.xi_form, t.xi_tip, 3)
    # The right flank of tooth 0: on the involute, at negative polar angle.
    r = np.hypot(middle[0], middle[1])
    xi = np.sqrt(np.maximum((r / t.r_base) ** 2 - 1, 0))
    on_involute = -(t.half_base - (xi - np.arctan(xi)))
    flank = boundary[(np.abs(np.arctan2(middle[1], middle[0]) - on_involute) * r < 0.15) & (r > t.r_form - 1e-6) & (r < t.r_tip - 0.02)
                     & (np.abs(middle[2]) < WIDTH / 2 - 1e-6)]
    facets = FacetBasis(m, element, facets=flank, intorder=8)
    loads = []
    for station in range(len(STATIONS)):

        def share(x):
            angle = np.sqrt(np.maximum((np.hypot(x[0], x[1]) / t.r_base) ** 2 - 1, 0))
            return hat(angle, rolls, 1) * hat(x[2], STATIONS, station)

        @LinearForm
        def pressure(v, w):
            angle = np.sqrt(np.maximum((np.hypot(w.x[0], w.x[1]) / t.r_base) ** 2 - 1, 0))
            turn = t.half_base - angle
            # Inward normal of the flank at positive polar angle, mirrored.
            return share(w.x) * (np.sin(turn) * v[0] + np.cos(turn) * v[1])

        @LinearForm
        def total(v, w):
            return share(w.x) * v[0]

        everywhere = np.zeros(basis.N)
        everywhere[basis.nodal_dofs[0]] = everywhere[basis.facet_dofs[0]] = 1
        everywhere[basis.edge_dofs[0]] = everywhere[basis.interior_dofs[0]] = 1
        loads.append(pressure.assemble(facets) / (total.assemble(facets) @ everywhere))
    back = boundary[np.abs(middle[2] + WIDTH / 2 + STUB[0]) < 1e-6]
    end = FacetBasis(m, element, facets=back, intorder=4)
    bearing = [LinearForm(lambda v, w, axis=axis: v[axis]).assemble(end) / (np.pi * SHAFT[0] ** 2) for axis in range(2)]
    clamped = basis.get_dofs(lambda x: np.abs(x[2] - WIDTH / 2 - STUB[1]) < 1e-6).all()
    free = np.setdiff1d(np.arange(basis.N), clamped)
    right = np.array([*bearing, *loads]).T[free]
    solver = PyPardisoSolver(mtype=2)
    soft = right.T @ solver.solve(sp.triu(k[free][:, free], format="csr"), right)
    held = np.linalg.solve(soft[:2, :2], soft[:2, 2:])
    return 1e3 * (soft[2:, 2:] - soft[2:, :2] @ held), held.T, len(free)


def main(folder):
    t = Tooth(z=TEETH, m=MODULE, x=0.2)
    coarse, fine = (answers(t, *sizes) for sizes in SIZES)
    own = np.sqrt(np.diag(fine[0]))
    left = np.abs(fine[0] - coarse[0]) / np.outer(own, own)
    force = np.linalg.norm(fine[1] - coarse[1], axis=1) / np.linalg.norm(fine[1], axis=1)
    print(fine, coarse, left, force, sep="\n")
    folder = Path(folder)
    folder.mkdir(exist_ok=True)
    with open(folder / "data.csv", "w") as out:
        names = [f"deflection_at_{z:g}_mm_nm_per_N" for z in STATIONS]
        out.write(",".join(["load_at_mm", *names, "bearing_x_N_per_N", "bearing_y_N_per_N"]) + "\n")
        for z, row, reaction in zip(STATIONS, 1e3 * fine[0], fine[1]):
            out.write(",".join([f"{z:g}", *(f"{value:.6g}" for value in row), *(f"{value:.6g}" for value in reaction)]) + "\n")
    print(f"largest change from {coarse[2]} to {fine[2]} degrees of freedom: {left.max():.2e}, bearing {force.max():.2e}")


if __name__ == "__main__":
    main(sys.argv[1])
