"""Strains from gradients, in the order xx, yy, zz, xy, yz, xz with engineering shear."""

import numpy as np


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
