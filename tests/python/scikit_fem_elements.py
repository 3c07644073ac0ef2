"""The elements by scikit-fem, in our order of nodes and degrees of freedom."""

import numpy as np
import scipy.spatial
import skfem
from skfem.models.elasticity import lame_parameters, linear_elasticity

from distorted_bodies import CORNERS, DENSITY, NODES_20, POISSON, YOUNG_PA
from strains import engineering


class ScikitFem:
    """The plain brick by scikit-fem, in our order of nodes and degrees of freedom."""

    def __init__(self, body):
        # Which VTK corner lies where scikit-fem's reference brick [0, 1]^3 has its k-th.
        corner = [np.flatnonzero(np.all(CORNERS == 2.0 * at - 1.0, axis=1))[0] for at in skfem.ElementHex1.doflocs]
        self.mesh = skfem.MeshHex(body.points.T.copy(), body.hexes[:, corner].T.copy())
        # An order of 3 is two points a direction.
        self.basis = skfem.Basis(self.mesh, skfem.ElementVector(skfem.ElementHex1()), intorder=3)
        assert self.basis.X.shape[-1] == 8
        # Our degree of freedom 3 n + a is theirs nodal_dofs[a, n].
        self.theirs = self.basis.nodal_dofs.T.ravel()
        # They may keep the points in an order of their own.
        assert np.array_equal(self.mesh.p.T, body.points)

    def stiffness(self):
        k = linear_elasticity(*lame_parameters(YOUNG_PA, POISSON)).assemble(self.basis)
        return k.tocsr()[self.theirs][:, self.theirs]

    def mass(self):
        # An order of 5 is three points a direction, as ours has for the mass of both elements.
        basis = skfem.Basis(self.mesh, self.basis.elem, intorder=5)
        product = skfem.BilinearForm(lambda u, v, w: DENSITY * sum(u[a] * v[a] for a in range(3)))
        return product.assemble(basis).tocsr()[self.theirs][:, self.theirs]

    def centre_strain(self, displacement):
        centre = skfem.Basis(self.mesh, self.basis.elem, quadrature=(np.full((3, 1), 0.5), np.ones(1)))
        theirs = np.empty(displacement.size)
        theirs[self.theirs] = displacement.ravel()
        gradient = centre.interpolate(theirs).grad[..., 0]  # displacement axis, derivative axis, element
        return engineering(np.moveaxis(gradient, -1, 0))


class ScikitFem20(ScikitFem):
    """The twenty-node brick by scikit-fem, in our order of nodes and degrees of freedom.

    scikit-fem's curved brick has 27 nodes; the seven more, on faces and in the middle, are put where the twenty-node map
    has them, so that both maps are the same.
    """

    def __init__(self, body):
        corner = [np.flatnonzero(np.all(CORNERS == 2.0 * at - 1.0, axis=1))[0] for at in skfem.ElementHex1.doflocs]
        used = np.unique(body.hexes[:, :8])
        assert np.array_equal(used, np.arange(len(used)))
        straight = skfem.MeshHex(body.points[used].T.copy(), body.hexes[:, corner].T.copy())
        curved = skfem.MeshHex2.from_mesh(straight)
        # The Lagrange nodes of the curved mesh, element by element, from our twenty.
        places = 2.0 * skfem.ElementHex2.doflocs - 1.0
        shape = np.array([serendipity(at) for at in places])
        dofs = curved.dofs.element_dofs
        points = np.full((3, curved.doflocs.shape[1]), np.nan)
        for element, nodes in enumerate(body.hexes):
            points[:, dofs[:, element]] = (shape @ body.points[nodes]).T
        assert np.isfinite(points).all()
        self.mesh = skfem.MeshHex2(points, curved.t)
        # An order of 5 is three points a direction.
        self.basis = skfem.Basis(self.mesh, skfem.ElementVector(skfem.ElementHexS2()), intorder=5)
        assert self.basis.X.shape[-1] == 27
        # Which VTK node lies where scikit-fem's element has its k-th; three displacements each.
        order = [np.flatnonzero(np.all(NODES_20 == 2.0 * at - 1.0, axis=1))[0] for at in skfem.ElementHexS2.doflocs]
        self.theirs = np.full(body.points.size, -1)
        for element, nodes in enumerate(body.hexes):
            ours = 3 * nodes[order][:, None] + np.arange(3)
            self.theirs[ours.ravel()] = self.basis.element_dofs[:, element]
        assert (np.sort(self.theirs) == np.arange(body.points.size)).all()


class ScikitFemTet(ScikitFem):
    """The ten-node tetrahedron by scikit-fem, nodes found by where they are."""

    def __init__(self, body):
        tree = scipy.spatial.cKDTree(body.straight)
        used = np.unique(body.tets[:, :4])
        assert np.array_equal(used, np.arange(len(used)))
        curved = skfem.MeshTet2.from_mesh(skfem.MeshTet(body.straight[used].T.copy(), body.tets[:, :4].T.copy()))
        distance, node = tree.query(curved.doflocs.T)
        assert distance.max() < 1e-12
        self.mesh = skfem.MeshTet2(body.points[node].T.copy(), curved.t)
        element = skfem.ElementVector(skfem.ElementTetP2())
        self.basis = skfem.Basis(self.mesh, element, quadrature=tetrahedron_rule())
        # Three displacements at each vertex and edge, numbered through.
        distance, node = scipy.spatial.cKDTree(body.points).query(self.basis.doflocs.T)
        assert distance.max() < 1e-12
        self.theirs = np.full(body.points.size, -1)
        for dofs in (self.basis.nodal_dofs, self.basis.edge_dofs):
            for axis in range(3):
                self.theirs[3 * node[dofs[axis]] + axis] = dofs[axis]
        assert (np.sort(self.theirs) == np.arange(body.points.size)).all()


def serendipity(natural):
    """The twenty shape functions at a point: the quadratic polynomials that are 1 at one node and 0 at the others.

    Found by inverting the matrix of the twenty monomials at the nodes, not from a formula.
    """
    powers = np.array([
        (i, j, k) for i in range(3) for j in range(3) for k in range(3) if sum(p == 2 for p in (i, j, k)) <= 1
    ])
    monomials = lambda x: np.prod(x[..., None, :] ** powers, axis=-1)
    return np.linalg.solve(monomials(NODES_20).T, monomials(np.asarray(natural, dtype=float)))


def tetrahedron_rule():
    """Eight points of degree 3 (Yu 1984): two on each line from a corner to the centre."""
    points, weights = [], []
    for at, weight in ((0.3281633025163817, 0.1362178425370874), (0.1080472498984286, 0.1137821574629126)):
        for corner in range(4):
            volume = np.full(4, at)
            volume[corner] = 1.0 - 3.0 * at
            points.append(volume[1:])
            weights.append(weight / 6.0)
    return np.array(points).T, np.array(weights)
