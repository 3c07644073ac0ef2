"""The brick with incompatible modes of Taylor, Beresford and Wilson (1976), written out in NumPy."""

import numpy as np
import scipy.sparse

from distorted_bodies import CORNERS, POISSON, YOUNG_PA
from strains import strain_operator

GAUSS_POINTS = CORNERS / np.sqrt(3.0)  # each of weight 1


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
