"""Whether displacements of a gear of ten-node tetrahedra under given loads are those of scikit-fem's stiffness on the same mesh.

Run by tests/tests/validation/tetrahedra.rs: arguments are mesh file, Young's modulus (Pa), Poisson's ratio, and the names of two files of
float64 columns over all degrees of freedom: loads (N) and as many displacements (m); and fields. Prints, one number a line, the
products x' K x of the fields, and for each load the largest residual over the largest load and the relative errors of the
compliances between it and every load. The set "bore" is held.
"""

import sys

import numpy as np
import scipy.sparse
import skfem
from skfem.models.elasticity import lame_parameters

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


basis = skfem.Basis(body, skfem.ElementTetP2(), quadrature=rule())
dof = np.full(len(points), -1)
dof[node] = np.concatenate([basis.nodal_dofs[0], basis.edge_dofs[0]])
assert np.array_equal(np.sort(dof), np.arange(len(points)))
assert np.allclose(basis.doflocs[:, dof].T, points, rtol=0, atol=1e-12)


def gradients(i, j):
    """The integrals of the derivative of one shape function along axis i times that of another along axis j."""
    form = skfem.BilinearForm(lambda u, v, w: v.grad[i] * u.grad[j])
    return form.assemble(basis).tocsr()[dof][:, dof]


# lambda div u div v + 2 mu eps(u) : eps(v) for v along axis i and u along axis j. Of scalar shape functions: forms of
# vectors have nine times the products, most of them with zero.
lame_lambda, lame_mu = lame_parameters(young_pa, poisson)
g = {(i, j): gradients(i, j) for i in range(3) for j in range(i, 3)}
g.update({(j, i): g[i, j].T for i, j in [(0, 1), (0, 2), (1, 2)]})
every = g[0, 0] + g[1, 1] + g[2, 2]
# Degree of freedom 3 n + i of node n.
k = sum(
    scipy.sparse.kron(
        lame_lambda * g[i, j] + lame_mu * g[j, i] + (lame_mu * every if i == j else 0.0 * every),
        scipy.sparse.coo_matrix(([1.0], ([i], [j])), shape=(3, 3)),
        format="csr",
    )
    for i in range(3)
    for j in range(3)
)

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
