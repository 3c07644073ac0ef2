"""Whether displacements of a gear of ten-node tetrahedra under given loads are those of scikit-fem's stiffness on the same mesh.

Run by tests/tests/validation/tetrahedra.rs: arguments are mesh file, Young's modulus (Pa), Poisson's ratio, and the names of two files of
float64 columns over all degrees of freedom: loads (N) and as many displacements (m); and fields. Prints, one number a line, the
products x' K x of the fields, and for each load the largest residual over the largest load and the relative errors of the
compliances between it and every load. The set "bore" is held.
"""

import sys

import numpy as np
import skfem
from skfem.models.elasticity import lame_parameters, linear_elasticity

import gearmesh

path, young_pa, poisson = sys.argv[1], float(sys.argv[2]), float(sys.argv[3])
loads_file, fields_file = sys.argv[4:6]
mesh = gearmesh.read_mesh(path)
points, tets = mesh["points"], mesh["cells"]["tet10"].astype(np.int64)
corners, t = np.unique(tets[:, :4], return_inverse=True)
straight = skfem.MeshTet(points[corners].T.copy(), t.reshape(-1, 4).T.copy())
curved = skfem.MeshTet2.from_mesh(straight)
# Our node in the middle of each of their edges.
ends = np.sort(tets[:, [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]]].reshape(-1, 2), axis=1)
key = lambda pairs: pairs[:, 0] * len(points) + pairs[:, 1]
known, first = np.unique(key(ends), return_index=True)
theirs = np.sort(corners[curved.edges.T], axis=1)
place = np.searchsorted(known, key(theirs))
assert np.array_equal(known[place], key(theirs))
node = np.concatenate([corners, tets[:, 4:].ravel()[first][place]])
assert np.array_equal(np.sort(node), np.arange(len(points)))
body = skfem.MeshTet2(points[node].T.copy(), curved.t)


def rule():
    """Eight points of degree 3 (Yu 1984), those of the Rust element: two on each line from a corner to the centre."""
    places, weights = [], []
    for at, weight in ((0.3281633025163817, 0.1362178425370874), (0.1080472498984286, 0.1137821574629126)):
        for corner in range(4):
            volume = np.full(4, at)
            volume[corner] = 1.0 - 3.0 * at
            places.append(volume[1:])
            weights.append(weight / 6.0)
    return np.array(places).T, np.array(weights)


element = skfem.ElementVector(skfem.ElementTetP2())
basis = skfem.Basis(body, element, quadrature=rule())
dof = np.full(points.size, -1)
for dofs, nodes in ((basis.nodal_dofs, node[: len(corners)]), (basis.edge_dofs, node[len(corners) :])):
    for axis in range(3):
        dof[3 * nodes + axis] = dofs[axis]
assert np.array_equal(np.sort(dof), np.arange(points.size))
assert np.allclose(basis.doflocs[:, dof].T.reshape(-1, 3, 3)[:, 0], points, rtol=0, atol=1e-12)
elasticity = linear_elasticity(*lame_parameters(young_pa, poisson))
# Two thousand elements at once: what scikit-fem makes of them stays in the cache.
parts = np.array_split(np.arange(body.nelements), body.nelements // 2000 + 1)
k = sum(elasticity.assemble(skfem.Basis(body, element, elements=part, quadrature=rule())) for part in parts)
k = k.tocsr()[dof][:, dof]

fields = np.fromfile(fields_file).reshape(-1, points.size)
for field in fields:
    print(repr(float(field @ (k @ field))))
held = (3 * mesh["point_sets"]["bore"].astype(np.int64)[:, None] + np.arange(3)).ravel()
loads = np.fromfile(loads_file).reshape(2, -1, points.size)
for load, displacement in zip(*loads):
    assert not displacement[held].any()
    rest = load - k @ displacement
    rest[held] = 0.0
    # The residual's work on the other displacements is the error of the compliance between the loads, to its second
    # order.
    print(repr(float(np.abs(rest).max() / np.abs(load).max())))
    for other, at in zip(*loads):
        print(repr(float(at @ rest / (other @ displacement))))
