"""Linear elasticity with 9-node quads (plane strain) and 27-node hexahedra of extruded meshes. N, mm, MPa."""

import numpy as np
import scipy.sparse as sp
from pypardiso import PyPardisoSolver

E_MPA, NU = 210e3, 0.3
LAMBDA = E_MPA * NU / ((1 + NU) * (1 - 2 * NU))
MU = E_MPA / (2 * (1 + NU))


def quad1d(t):
    """Quadratic shape functions of nodes -1, 0, 1 and their derivatives at t."""
    t = np.asarray(t, float)
    return (np.stack([t * (t - 1) / 2, 1 - t**2, t * (t + 1) / 2], -1), np.stack([t - 0.5, -2 * t, t + 0.5], -1))


def section_integrals(nodes, quads, order=4):
    """I[i][j] (ne, 9, 9) = integral of D_i N_a D_j N_b over each quad, D_0 = d/dx, D_1 = d/dy, D_2 = 1."""
    t, w = np.polynomial.legendre.leggauss(order)
    out = [[0.0] * 3 for _ in range(3)]
    x = nodes[quads]
    smallest = np.inf
    for i in range(order):
        for j in range(order):
            (na, da), (nb, db) = quad1d(t[i]), quad1d(t[j])
            n = np.outer(nb, na).ravel()
            dn = np.stack([np.outer(nb, da).ravel(), np.outer(db, na).ravel()])
            jac = np.einsum("ka,eaj->ekj", dn, x)
            det = jac[:, 0, 0] * jac[:, 1, 1] - jac[:, 0, 1] * jac[:, 1, 0]
            assert det.min() > 0, "element turned inside out"
            smallest = min(smallest, det.min())
            g = np.linalg.solve(jac, np.broadcast_to(dn, (len(x), 2, 9)))
            d = [g[:, 0], g[:, 1], np.broadcast_to(n, g[:, 0].shape)]
            wd = w[i] * w[j] * det
            for a in range(3):
                for b in range(3):
                    out[a][b] = out[a][b] + np.einsum("e,ea,eb->eab", wd, d[a], d[b])
    return out, smallest


def element_stiffness(moment, dim):
    """moment(i, j) = integral of d_i N_a d_j N_b; returns (ne, n, dim, n, dim)."""
    tr = sum(moment(k, k) for k in range(dim))
    ne, n = tr.shape[:2]
    k = np.empty((ne, n, dim, n, dim))
    for i in range(dim):
        for j in range(dim):
            k[:, :, i, :, j] = LAMBDA * moment(i, j) + MU * moment(j, i) + (MU * tr if i == j else 0)
    return k


def plane_strain_stiffness(nodes, quads):
    """Per unit width, degrees of freedom 2 * node + component."""
    I, _ = section_integrals(nodes, quads)
    ke = element_stiffness(lambda i, j: I[i][j], 2).reshape(len(quads), 18, 18)
    dof = (2 * quads[:, :, None] + np.arange(2)).reshape(len(quads), 18)
    return scatter(ke, dof, 2 * len(nodes))


def scatter(ke, dof, n):
    m = dof.shape[1]
    rows = np.repeat(dof, m, axis=1).ravel().astype(np.int32)
    cols = np.tile(dof, (1, m)).ravel().astype(np.int32)
    return sp.coo_matrix((ke.ravel(), (rows, cols)), shape=(n, n)).tocsr()


class Extruded:
    """Section mesh times z layers, some elements left out. Half of the gear: z = 0 is the plane of symmetry."""

    def __init__(self, nodes, quads, z_layers, active):
        """active (ne, nl): which layers of which quad exist."""
        self.nodes2, self.quads, self.zl = nodes, quads, np.asarray(z_layers, float)
        nl = len(self.zl) - 1
        self.z = np.sort(np.concatenate([self.zl, (self.zl[1:] + self.zl[:-1]) / 2]))
        self.nz = len(self.z)
        I, _ = section_integrals(nodes, quads)
        t, w = np.polynomial.legendre.leggauss(3)
        n, d = quad1d(t)
        full = 3 * len(nodes) * self.nz
        K = sp.csr_matrix((full, full))
        used = np.zeros((len(nodes), self.nz), bool)
        for l in range(nl):
            act = np.flatnonzero(active[:, l])
            if len(act) == 0:
                continue
            h = self.zl[l + 1] - self.zl[l]
            zs = [n, d * 2 / h]
            Z = [[np.einsum("q,qa,qb->ab", w * h / 2, zs[a], zs[b]) for b in range(2)] for a in range(2)]

            def moment(i, j):
                s = I[i if i < 2 else 2][j if j < 2 else 2][act]
                return np.einsum("eab,cd->eacbd", s, Z[int(i == 2)][int(j == 2)]).reshape(len(act), 27, 27)

            ke = element_stiffness(moment, 3).reshape(len(act), 81, 81)
            node = (quads[act][:, :, None] * self.nz + (2 * l + np.arange(3))).reshape(len(act), 27)
            dof = (3 * node[:, :, None] + np.arange(3)).reshape(len(act), 81)
            K = K + scatter(ke, dof, full)
            used.ravel()[node.ravel()] = True
        self.K = K.tocsr()
        free = np.repeat(used.ravel(), 3).reshape(len(nodes), self.nz, 3)
        free[:, 0, 2] = False  # symmetry
        self.used, self.free = used, free  # free (n2, nz, 3)

    def dof(self, node2, iz, comp):
        return 3 * (np.asarray(node2) * self.nz + iz) + comp

    def dofs_of(self, node2, iz=None):
        """All (node2, iz, 3) degrees of freedom as an array (len(node2), len(iz), 3)."""
        iz = np.arange(self.nz) if iz is None else np.asarray(iz)
        return 3 * (np.asarray(node2)[:, None, None] * self.nz + iz[None, :, None]) + np.arange(3)


def condense(K, keep):
    """Dense Schur complement of a symmetric sparse matrix on its last `keep` rows (the leading block is positive definite)."""
    n = K.shape[0]
    A = sp.triu(K + sp.csr_matrix((np.full(keep, 1e-300), (range(n - keep, n),) * 2), shape=(n, n)), format="csr")
    A.sort_indices()
    s = PyPardisoSolver(mtype=-2)
    s.set_iparm(1, 1)  # own settings
    s.set_iparm(2, 2)  # nested dissection
    s.set_iparm(10, 8)
    s.set_iparm(36, 1)  # Schur complement, dense
    s.perm = np.zeros(n, dtype=np.int32)
    s.perm[n - keep :] = 1
    s.set_phase(12)
    # the solver writes the keep x keep result at the start of its solution array, which has the size of the right-hand
    # side
    cols = -(-keep * keep // n)
    x = s._call_pardiso(A, np.zeros((n, cols)))
    S = x.ravel()[: keep * keep].reshape(keep, keep)
    s.free_memory(everything=True)
    return np.triu(S) + np.triu(S, 1).T
