"""Natural frequencies (Hz) of the eight-node body in a mesh file, its set "bore" held, by scikit-fem and ARPACK.

Run by tests/tests/validation/gear_modes.rs: arguments are mesh file, Young's modulus (Pa), Poisson's ratio, density (kg/m3), number of
modes; prints one frequency a line.
"""

import sys

import numpy as np
import scipy.sparse.linalg
import skfem
from skfem.models.elasticity import lame_parameters, linear_elasticity

import gearmesh

path = sys.argv[1]
young_pa, poisson, density = map(float, sys.argv[2:5])
count = int(sys.argv[5])
mesh = gearmesh.read_mesh(path)
# Natural coordinates of the corners in VTK order, and which of them lies where scikit-fem's [0, 1]^3 has its k-th.
corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
order = [np.flatnonzero(np.all(corners == at, axis=1))[0] for at in skfem.ElementHex1.doflocs]
body = skfem.MeshHex(mesh["points"].T.copy(), mesh["cells"]["hex8"].astype(np.int64)[:, order].T.copy())
assert np.array_equal(body.p.T, mesh["points"])
scalar = skfem.ElementHex1()
vector = skfem.ElementVector(scalar)


def assembled(form, element, intorder):
    """The matrix of the form, two thousand elements at once: what scikit-fem makes of them stays in the cache."""
    parts = np.array_split(np.arange(body.nelements), body.nelements // 2000 + 1)
    return sum(form.assemble(skfem.Basis(body, element, elements=part, intorder=intorder)) for part in parts)


# Gauss rules of two points a direction for the stiffness and three for the mass, as in the Rust elements.
k = assembled(linear_elasticity(*lame_parameters(young_pa, poisson)), vector, intorder=3)
# The same for each of the three components, which scikit-fem numbers together node by node.
m = scipy.sparse.kron(assembled(skfem.BilinearForm(lambda u, v, w: density * u * v), scalar, intorder=5), np.eye(3))
dofs = skfem.Basis(body, vector, intorder=3).nodal_dofs
assert np.array_equal(dofs, np.arange(dofs.size).reshape(-1, 3).T)
free = np.setdiff1d(np.arange(dofs.size), dofs[:, mesh["point_sets"]["bore"]].ravel())
k, m = (matrix.tocsc()[free][:, free] for matrix in (k, m))
# The default order of SuperLU is made for unsymmetric matrices and fills a solid's factor many times over.
factor = scipy.sparse.linalg.splu(k, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
inverse = scipy.sparse.linalg.LinearOperator(k.shape, factor.solve)
start = np.ones(len(free))
squares = scipy.sparse.linalg.eigsh(k, count, m, sigma=0.0, OPinv=inverse, v0=start, return_eigenvectors=False)
for square in np.sort(squares):
    print(repr(float(np.sqrt(square) / (2.0 * np.pi))))
