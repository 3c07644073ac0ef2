"""Stiffness, mass, displacements, strains and natural modes against scikit-fem and against elements written out here in NumPy.

The other side shares no code with the Rust one: scikit-fem assembles the plain brick and the twenty-node brick, the
NumPy functions below the brick with incompatible modes. All sides use the same Gauss rule, 2x2x2 points with eight nodes
and 3x3x3 with twenty, so what is left is rounding: 1e-16 an operation, times the condition number of K (1.7e3 with eight
nodes) in a displacement. 1e-10 stands above both.
"""

import numpy as np
import pytest
import scipy.sparse
import scipy.sparse.linalg
import scipy.spatial
import skfem
from skfem.models.elasticity import lame_parameters, linear_elasticity

import gearmesh

YOUNG_PA, POISSON, DENSITY = 210e9, 0.3, 7800.0
TOLERANCE = 1e-10

# Natural coordinates of the corners in VTK order.
CORNERS = np.array([
    [-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1],
    [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1],
], dtype=float)
GAUSS_POINTS = CORNERS / np.sqrt(3.0)  # each of weight 1


def distorted_block():
    """A block of 4 x 3 x 5 elements (m), twisted and bent, every node moved at random, numbered at random."""
    shape, lengths = (4, 3, 5), (0.03, 0.02, 0.04)
    random = np.random.default_rng(20)
    grid = np.stack(np.meshgrid(*(np.arange(n + 1) for n in shape), indexing="ij"), axis=-1).reshape(-1, 3)
    # 0.15 of an element's edge: far from flat-sided, and no corner turns inside out.
    cell = np.array(lengths) / shape
    points = (grid + random.uniform(-0.15, 0.15, grid.shape)) * cell
    angle = 12.0 * points[:, 2]  # 27 degrees over the length
    c, s = np.cos(angle), np.sin(angle)
    points = np.column_stack([
        c * points[:, 0] - s * points[:, 1] + 4.0 * points[:, 2] ** 2,
        s * points[:, 0] + c * points[:, 1],
        points[:, 2],
    ])
    new_number = random.permutation(len(points))
    number = lambda ijk: new_number[np.ravel_multi_index(ijk.T, np.array(shape) + 1)]
    first_corners = grid[np.all(grid < shape, axis=1)]
    hexes = np.array([number(first + (CORNERS.astype(int) + 1) // 2) for first in first_corners])
    renumbered = np.empty_like(points)
    renumbered[new_number] = points
    held = np.sort(new_number[grid[:, 2] == 0])
    return renumbered, hexes, held


class Body:
    """The block, its file, and random nodal forces (N)."""

    def __init__(self, path):
        self.path = path
        self.points, self.hexes, self.held = distorted_block()
        gearmesh.write_mesh(path, self.points, {"hex8": self.hexes})
        self.force = np.random.default_rng(21).normal(scale=100.0, size=self.points.shape)

    def stiffness(self, element):
        """K of the Rust side as a SciPy matrix."""
        size = self.points.size
        return scipy.sparse.csc_matrix(gearmesh.stiffness(self.path, YOUNG_PA, POISSON, element), shape=(size, size))

    def mass(self, element):
        """M of the Rust side as a SciPy matrix."""
        size = self.points.size
        return scipy.sparse.csc_matrix(gearmesh.mass(self.path, DENSITY, element), shape=(size, size))

    def natural_modes(self, element, count):
        """Frequencies (Hz), shapes and residuals of the Rust side."""
        return gearmesh.natural_modes(self.path, YOUNG_PA, POISSON, DENSITY, element, self.held, count)

    def modes_by_scipy(self, k, m, count):
        """Frequencies (Hz) and shapes by ARPACK for another stiffness and mass."""
        free = self.free()
        k, m = (matrix.tocsc()[free][:, free] for matrix in (k, m))
        squares, columns = scipy.sparse.linalg.eigsh(k, count, m, sigma=0.0, v0=np.ones(len(free)))
        shapes = np.zeros((count, self.points.size))
        shapes[:, free] = columns.T
        return np.sqrt(squares) / (2.0 * np.pi), shapes

    def solve(self, element):
        """Displacement of the Rust side."""
        return gearmesh.solve(self.path, YOUNG_PA, POISSON, element, self.held, self.force)

    def strain(self, element, displacement, natural=(0.0, 0.0, 0.0)):
        """Strain of the Rust side in every element."""
        return gearmesh.strain(self.path, YOUNG_PA, POISSON, element, displacement, natural)

    def free(self):
        """Degrees of freedom that are not held."""
        return np.setdiff1d(np.arange(self.points.size), (3 * self.held[:, None] + np.arange(3)).ravel())

    def displacement_by_scipy(self, k):
        """Displacement under the forces for another stiffness, by SciPy's LU factorisation."""
        free = self.free()
        displacement = np.zeros(self.points.size)
        displacement[free] = scipy.sparse.linalg.spsolve(k.tocsc()[free][:, free], self.force.ravel()[free])
        return displacement.reshape(-1, 3)


@pytest.fixture(scope="module")
def body(tmp_path_factory):
    return Body(tmp_path_factory.mktemp("skfem") / "block.h5")


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


# The corners at the ends of each edge, in VTK order of the mid-edge nodes.
EDGES = np.array([
    [0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7],
])
# Natural coordinates of all twenty nodes.
NODES_20 = np.vstack([CORNERS, CORNERS[EDGES].mean(axis=1)])


class QuadraticBody(Body):
    """The block with a node on every edge, off the chord by up to 0.06 of its length."""

    def __init__(self, path):
        self.path = path
        corners, hexes, held = distorted_block()
        random = np.random.default_rng(22)
        ends = np.sort(hexes[:, EDGES], axis=-1).reshape(-1, 2)
        edges, of_element = np.unique(ends, axis=0, return_inverse=True)
        lengths = np.linalg.norm(np.diff(corners[edges], axis=1)[:, 0], axis=1)
        middles = corners[edges].mean(axis=1) + 0.06 * lengths[:, None] * random.uniform(-1.0, 1.0, (len(edges), 3))
        self.points = np.vstack([corners, middles])
        self.hexes = np.hstack([hexes, len(corners) + of_element.reshape(-1, 12)])
        self.held = np.concatenate([held, len(corners) + np.flatnonzero(np.isin(edges, held).all(axis=1))])
        gearmesh.write_mesh(path, self.points, {"hex20": self.hexes})
        self.force = random.normal(scale=100.0, size=self.points.shape)


@pytest.fixture(scope="module")
def quadratic_body(tmp_path_factory):
    return QuadraticBody(tmp_path_factory.mktemp("skfem20") / "block.h5")


def serendipity(natural):
    """The twenty shape functions at a point: the quadratic polynomials that are 1 at one node and 0 at the others.

    Found by inverting the matrix of the twenty monomials at the nodes, not from a formula.
    """
    powers = np.array([
        (i, j, k) for i in range(3) for j in range(3) for k in range(3) if sum(p == 2 for p in (i, j, k)) <= 1
    ])
    monomials = lambda x: np.prod(x[..., None, :] ** powers, axis=-1)
    return np.linalg.solve(monomials(NODES_20).T, monomials(np.asarray(natural, dtype=float)))


class TetrahedralBody(Body):
    """The block cut in ten-node tetrahedra, with bent edges."""

    def __init__(self, path):
        self.path = path
        corners, hexes, held = distorted_block()
        random = np.random.default_rng(23)
        # Six about the diagonal 0-6 of each brick.
        cut = [[0, 1, 2, 6], [0, 5, 1, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 4, 5, 6], [0, 7, 4, 6]]
        tets = hexes[:, cut].reshape(-1, 4)
        ends = np.sort(tets[:, [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]]], axis=-1).reshape(-1, 2)
        edges, of_element = np.unique(ends, axis=0, return_inverse=True)
        lengths = np.linalg.norm(np.diff(corners[edges], axis=1)[:, 0], axis=1)
        self.straight = np.vstack([corners, corners[edges].mean(axis=1)])
        bends = 0.05 * lengths[:, None] * random.uniform(-1.0, 1.0, (len(edges), 3))
        self.points = self.straight + np.vstack([0.0 * corners, bends])
        self.tets = np.hstack([tets, len(corners) + of_element.reshape(-1, 6)])
        self.held = np.concatenate([held, len(corners) + np.flatnonzero(np.isin(edges, held).all(axis=1))])
        gearmesh.write_mesh(path, self.points, {"tet10": self.tets})
        self.force = random.normal(scale=100.0, size=self.points.shape)


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


def test_tet10_stiffness_and_displacement_are_those_of_scikit_fem(tmp_path):
    body = TetrahedralBody(tmp_path / "block.h5")
    fem = ScikitFemTet(body)
    assert len(body.tets) == 360
    assert entrywise(body.stiffness("tet10"), fem.stiffness()) < TOLERANCE
    assert in_norm(body.solve("tet10"), body.displacement_by_scipy(fem.stiffness())) < TOLERANCE


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


def engineering(gradient):
    """Strains xx, yy, zz, xy, yz, xz with engineering shear of displacement gradients (..., 3, 3)."""
    twice = gradient + np.swapaxes(gradient, -1, -2)
    normal = 0.5 * np.stack([twice[..., a, a] for a in range(3)], axis=-1)
    shear = np.stack([twice[..., 0, 1], twice[..., 1, 2], twice[..., 0, 2]], axis=-1)
    return np.concatenate([normal, shear], axis=-1)


def strain_operator(gradients):
    """Strain operator (6, 3 m) of m scalar functions with the gradients (m, 3), three directions each."""
    # Axes: function, direction, displacement axis, derivative.
    unit = np.eye(3)[None, :, :, None] * gradients[:, None, None, :]
    return engineering(unit).reshape(-1, 6).T


def elasticity():
    """Elasticity matrix (6, 6) in Pa: the inverse of the compliance of Hooke's law."""
    compliance = np.zeros((6, 6))
    compliance[:3, :3] = ((1.0 + POISSON) * np.eye(3) - POISSON) / YOUNG_PA
    compliance[3:, 3:] = 2.0 * (1.0 + POISSON) / YOUNG_PA * np.eye(3)
    return np.linalg.inv(compliance)


def shape_gradients(corners, natural):
    """Gradients (8, 3) of the trilinear functions in space and the matrix d x_i / d xi_j."""
    factors = 0.5 * (1.0 + CORNERS * natural)
    in_natural = np.column_stack([
        0.5 * CORNERS[:, k] * np.delete(factors, k, axis=1).prod(axis=1) for k in range(3)
    ])
    jacobian = corners.T @ in_natural
    return in_natural @ np.linalg.inv(jacobian), jacobian


def incompatible_operators(corners, natural):
    """Strain operators of the nodes (6, 24) and of the modes 1 - xi_k^2 (6, 9) at a point, and det J there.

    Taylor, Beresford and Wilson (1976): the modes take the Jacobian of the centre, scaled by det J(0) / det J.
    """
    gradients, jacobian = shape_gradients(corners, natural)
    _, centre = shape_gradients(corners, np.zeros(3))
    scale = np.linalg.det(centre) / np.linalg.det(jacobian)
    modes = scale * np.diag(-2.0 * np.asarray(natural)) @ np.linalg.inv(centre)
    return strain_operator(gradients), strain_operator(modes), np.linalg.det(jacobian)


def incompatible_element(corners):
    """Condensed stiffness (24, 24) and the amplitudes of the modes for given displacements (9, 24)."""
    full, d = np.zeros((33, 33)), elasticity()
    for point in GAUSS_POINTS:
        nodes, modes, determinant = incompatible_operators(corners, point)
        both = np.hstack([nodes, modes])
        full += determinant * both.T @ d @ both
    amplitudes = -np.linalg.solve(full[24:, 24:], full[24:, :24])
    return full[:24, :24] + full[:24, 24:] @ amplitudes, amplitudes


def incompatible_stiffness(body):
    """K of the incompatible bricks, scattered element by element."""
    k = np.zeros((body.points.size, body.points.size))
    for nodes in body.hexes:
        dofs = (3 * nodes[:, None] + np.arange(3)).ravel()
        k[np.ix_(dofs, dofs)] += incompatible_element(body.points[nodes])[0]
    return scipy.sparse.csr_matrix(k)


def incompatible_strain(body, displacement, natural):
    """Strain of the incompatible bricks with their modes."""
    rows = []
    for nodes in body.hexes:
        corners, u = body.points[nodes], displacement[nodes].ravel()
        of_nodes, of_modes, _ = incompatible_operators(corners, natural)
        rows.append(of_nodes @ u + of_modes @ (incompatible_element(corners)[1] @ u))
    return np.array(rows)


def entrywise(found, expected):
    """Largest difference of two matrices relative to the largest entry."""
    return abs(found - expected).max() / abs(expected).max()


def in_norm(found, expected):
    """Norm of the difference relative to the norm."""
    return np.linalg.norm(found - expected) / np.linalg.norm(expected)


def test_hex8_stiffness_is_that_of_scikit_fem(body):
    assert entrywise(body.stiffness("hex8"), ScikitFem(body).stiffness()) < TOLERANCE


def test_hex8_displacement_is_that_of_scikit_fem(body):
    displacement = body.solve("hex8")
    assert in_norm(displacement, body.displacement_by_scipy(ScikitFem(body).stiffness())) < TOLERANCE
    assert not displacement[body.held].any()


def test_hex8_strain_at_the_centres_is_that_of_scikit_fem(body):
    fem = ScikitFem(body)
    displacement = body.displacement_by_scipy(fem.stiffness())
    expected = fem.centre_strain(displacement)
    assert expected.shape == (len(body.hexes), 6)
    assert in_norm(body.strain("hex8", displacement), expected) < TOLERANCE
    # The whole chain: our displacement, our strain.
    assert in_norm(body.strain("hex8", body.solve("hex8")), expected) < TOLERANCE


def test_incompatible_stiffness_is_that_of_taylor_beresford_wilson(body):
    k = body.stiffness("hex8-incompatible")
    assert entrywise(k, incompatible_stiffness(body)) < TOLERANCE
    # The two elements are far apart: a mix-up could not pass.
    assert entrywise(k, body.stiffness("hex8")) > 1e-2


def test_incompatible_displacement_is_that_of_taylor_beresford_wilson(body):
    expected = body.displacement_by_scipy(incompatible_stiffness(body))
    assert in_norm(body.solve("hex8-incompatible"), expected) < TOLERANCE
    assert in_norm(body.solve("hex8"), expected) > 1e-2


@pytest.mark.parametrize("natural", [(0.0, 0.0, 0.0), (0.3, -0.8, 0.5), (1.0, -1.0, 1.0)])
def test_incompatible_strain_is_that_of_taylor_beresford_wilson(body, natural):
    displacement = body.solve("hex8-incompatible")
    expected = incompatible_strain(body, displacement, natural)
    assert in_norm(body.strain("hex8-incompatible", displacement, natural), expected) < TOLERANCE


def test_hex20_stiffness_is_that_of_scikit_fem(quadratic_body):
    body = quadratic_body
    assert body.points.shape[0] == 119 + 1 + 286 and len(body.hexes) == 60
    assert entrywise(body.stiffness("hex20"), ScikitFem20(body).stiffness()) < TOLERANCE


def test_hex20_displacement_is_that_of_scikit_fem(quadratic_body):
    body = quadratic_body
    displacement = body.solve("hex20")
    assert in_norm(displacement, body.displacement_by_scipy(ScikitFem20(body).stiffness())) < TOLERANCE
    assert not displacement[body.held].any()


def test_hex20_strain_at_the_centres_is_that_of_scikit_fem(quadratic_body):
    body = quadratic_body
    fem = ScikitFem20(body)
    displacement = body.displacement_by_scipy(fem.stiffness())
    assert in_norm(body.strain("hex20", displacement), fem.centre_strain(displacement)) < TOLERANCE
    assert in_norm(body.strain("hex20", body.solve("hex20")), fem.centre_strain(displacement)) < TOLERANCE


def test_a_mesh_of_twenty_nodes_comes_back(quadratic_body):
    read = gearmesh.read_mesh(quadratic_body.path)
    assert np.array_equal(read["cells"]["hex20"], quadratic_body.hexes)


def test_an_element_takes_its_own_number_of_nodes(body, quadratic_body):
    with pytest.raises(ValueError, match="the elements hex8; hex20 is not among them"):
        body.stiffness("hex20")
    with pytest.raises(ValueError, match="the elements hex20; hex8 is not among them"):
        quadratic_body.stiffness("hex8")


@pytest.mark.parametrize("element", ["hex8", "hex20"])
def test_mass_and_natural_modes_are_those_of_scikit_fem(body, quadratic_body, element):
    body, fem_of = (body, ScikitFem) if element == "hex8" else (quadratic_body, ScikitFem20)
    fem, count = fem_of(body), 12
    m = fem.mass()
    assert entrywise(body.mass(element), m) < TOLERANCE
    expected, expected_shapes = body.modes_by_scipy(fem.stiffness(), m, count)
    frequencies, shapes, residuals = body.natural_modes(element, count)
    assert np.abs(frequencies / expected - 1.0).max() < 1e-8
    # The search stops at 1e-10 in the mass norm; the residual weighs what is left with the square of its frequency.
    assert residuals.max() < 1e-8
    assert not shapes[:, body.held].any()
    # Modal mass 1, and the same shapes but for the sign.
    overlap = shapes.reshape(count, -1) @ (m @ expected_shapes.T)
    assert np.abs(np.abs(overlap) - np.eye(count)).max() < 1e-6


def test_incompatible_modes_carry_no_mass(body):
    assert entrywise(body.mass("hex8-incompatible"), body.mass("hex8")) == 0.0
    # Softer with the same mass: every frequency is lower.
    assert (body.natural_modes("hex8-incompatible", 6)[0] < body.natural_modes("hex8", 6)[0]).all()


def test_the_default_element_has_incompatible_modes(body):
    data = gearmesh.stiffness(body.path, YOUNG_PA, POISSON)[0]
    assert np.array_equal(data, gearmesh.stiffness(body.path, YOUNG_PA, POISSON, "hex8-incompatible")[0])


def test_forces_in_any_memory_order(body):
    expected = body.solve("hex8")
    found = gearmesh.solve(body.path, YOUNG_PA, POISSON, "hex8", body.held.tolist(), np.asfortranarray(body.force))
    assert in_norm(found, expected) < TOLERANCE


def test_unknown_element_is_refused(body):
    with pytest.raises(ValueError, match='"hex9".*"hex8", "hex8-incompatible", "hex20"'):
        gearmesh.stiffness(body.path, YOUNG_PA, POISSON, "hex9")
    with pytest.raises(ValueError, match='"hex9".*"hex8", "hex8-incompatible", "hex20"'):
        gearmesh.solve(body.path, YOUNG_PA, POISSON, "hex9", body.held, body.force)
    with pytest.raises(ValueError, match='"hex9".*"hex8", "hex8-incompatible", "hex20"'):
        gearmesh.strain(body.path, YOUNG_PA, POISSON, "hex9", body.force)


def test_wrong_input_is_refused(body, tmp_path):
    solve = lambda held, force: gearmesh.solve(body.path, YOUNG_PA, POISSON, "hex8", held, force)
    with pytest.raises(FileNotFoundError):
        gearmesh.stiffness(tmp_path / "none.h5", YOUNG_PA, POISSON)
    with pytest.raises(ValueError, match="Poisson's ratio is 0.5"):
        gearmesh.stiffness(body.path, YOUNG_PA, 0.5)
    with pytest.raises(ValueError, match="not held against all six rigid motions"):
        solve([], body.force)
    for node in (-1, len(body.points), 2**62):
        with pytest.raises(ValueError, match=f"node {node} is to be held; the mesh has the nodes 0 to 119"):
            solve([node], body.force)
    with pytest.raises(ValueError, match=r"force has the shape \[119, 3\]; the mesh needs \[120, 3\]"):
        solve(body.held, body.force[1:])
    with pytest.raises(ValueError, match="force of node 7 is NaN"):
        force = body.force.copy()
        force[7, 2] = np.nan
        solve(body.held, force)
    with pytest.raises(ValueError, match="density is 0"):
        gearmesh.mass(body.path, 0.0)
    with pytest.raises(ValueError, match="0 natural modes were asked for; the model has 300 unknowns"):
        body.natural_modes("hex8", 0)
    with pytest.raises(ValueError, match="from -1 to 1"):
        body.strain("hex8", body.force, (0.0, 1.1, 0.0))
