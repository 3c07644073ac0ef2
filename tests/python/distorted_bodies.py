"""Distorted blocks of bricks and tetrahedra (m), their files, and what the Rust side computes on them."""

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

import gearmesh

YOUNG_PA, POISSON, DENSITY = 210e9, 0.3, 7800.0

# Natural coordinates of the corners in VTK order.
CORNERS = np.array([
    [-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1],
    [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1],
], dtype=float)
# The corners at the ends of each edge, in VTK order of the mid-edge nodes.
EDGES = np.array([
    [0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7],
])
# Natural coordinates of all twenty nodes.
NODES_20 = np.vstack([CORNERS, CORNERS[EDGES].mean(axis=1)])


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
