"""Compliance of the tooth flanks and strain of the root gauges for a whole gear, from one condensed tooth pitch.

`loads` are unit columns: right-flank section node k, component (x, y) in the tooth's own frame (tooth centre on x), spread
uniformly over slice s of the half width z >= 0 with resultant 1 N. Gauge columns are the dual vectors of the gauge strains.
"""

import time

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from fe import Extruded, condense, quad1d
from section import Section, section_parameters

GAUGE_LENGTH, GAUGE_WIDTH = 0.8, 3.0


def log(*a):
    print(time.strftime("%H:%M:%S"), *a, flush=True)


def gauge_weights(section, ext, side):
    """Dense dual vector g with strain = g . u: mean of t . du/ds over the gauge patch (z from 0 to half its width)."""
    line = section.profile[side]
    x = section.nodes[line]
    ne = (len(line) - 1) // 2
    eta = np.linspace(-1, 1, 401)
    n, d = quad1d(eta)
    w2 = np.zeros((len(line), 2))  # weights of (node, x/y) for the mean of t . du/ds
    s0, lo, hi = 0.0, section.s30 - GAUGE_LENGTH / 2, section.s30 + GAUGE_LENGTH / 2
    total = 0.0
    for e in range(ne):
        ids = np.arange(2 * e, 2 * e + 3)
        dx = d @ x[ids]
        speed = np.hypot(*dx.T)
        s = s0 + np.concatenate([[0], np.cumsum((speed[1:] + speed[:-1]) / 2 * np.diff(eta))])
        s0 = s[-1]
        # mean over arc length: integral of (t . sum d_k u_k / speed) speed d eta; ends of the patch cut by linear
        # weights
        ds = np.diff(s)
        frac = np.clip((np.minimum(s[1:], hi) - np.maximum(s[:-1], lo)) / ds, 0, 1)
        dm, tm = (d[1:] + d[:-1]) / 2, (dx[1:] + dx[:-1]) / 2
        sm = np.hypot(*tm.T)
        wgt = frac * ds / sm**2
        w2[ids] += np.einsum("q,qk,qc->kc", wgt, dm, tm)
        total += (frac * ds).sum()
    assert abs(total - GAUGE_LENGTH) < 2e-3, total
    w2 /= total
    wz = np.zeros(ext.nz)
    zt = GAUGE_WIDTH / 2
    for l in range(len(ext.zl) - 1):
        a, b = ext.zl[l], min(ext.zl[l + 1], zt)
        if b <= a:
            break
        t, w = np.polynomial.legendre.leggauss(3)
        zz = (a + b) / 2 + (b - a) / 2 * t
        nn, _ = quad1d(2 * (zz - ext.zl[l]) / (ext.zl[l + 1] - ext.zl[l]) - 1)
        wz[2 * l : 2 * l + 3] += (w * (b - a) / 2) @ nn / zt
    g = np.zeros(ext.K.shape[0])
    dof = ext.dofs_of(line)[:, :, :2]
    g[dof] = w2[:, None, :] * wz[None, :, None]
    return g


def load_columns(section, ext):
    """Sparse (dofs, slices * nodes * 2) unit loads; column (s, k, c) at (s * n_nodes + k) * 2 + c."""
    line = section.flank["right"]
    ns = len(ext.zl) - 1
    rows, cols, val = [], [], []
    for s in range(ns):
        for k, node in enumerate(line):
            for c in range(2):
                for a, w in enumerate((1 / 6, 4 / 6, 1 / 6)):
                    rows.append(ext.dof(node, 2 * s + a, c))
                    cols.append((s * len(line) + k) * 2 + c)
                    val.append(w)
    return sp.csc_matrix((val, (rows, cols)), shape=(ext.K.shape[0], ns * len(line) * 2))


class Pitch:
    """One pitch, condensed on boundary degrees of freedom in polar components.

    Body: hub (full width) to r_hub, web |z| < web_half from r_hub to r_rim, full width outside r_rim.
    web_half None: solid. With `ring_only` the pitch ends at r_rim and its inner arc (|z| < web_half) is boundary too.
    """

    def __init__(self, tooth, z_layers, mesh, r_bore=25.0, r_hub=35.0, r_rim=68.35, web_half=None, ring_only=False):
        radii = [] if ring_only else [(r_rim, r_hub, mesh["n_web"]), (r_hub, r_bore, mesh["n_hub"])]
        self.tooth, self.sec = tooth, Section(tooth, r_rim, radii, **section_parameters(mesh))
        sec = self.sec
        zl = np.asarray(z_layers)
        rc = sec.element_centre_radius()
        active = np.ones((len(sec.quads), len(zl) - 1), bool)
        if web_half is not None:
            active &= ~(((rc > r_hub) & (rc < r_rim))[:, None] & (zl[1:] > web_half + 1e-9)[None, :])
        t0 = time.time()
        self.ext = ext = Extruded(sec.nodes, sec.quads, zl, active)
        if not ring_only:
            bore = np.flatnonzero(np.abs(np.hypot(*sec.nodes.T) - r_bore) < 1e-7)
            ext.free[bore] = False
        log(f"pitch: {len(sec.nodes)} section nodes, {int(ext.free.sum())} dofs, assembled {time.time() - t0:.1f} s")
        F = load_columns(sec, ext)
        g = np.column_stack([gauge_weights(sec, ext, s) for s in ("right", "left")])
        F = sp.hstack([F, sp.csc_matrix(g)]).tocsc()
        # boundary: low side, high side, (inner arc without its ends)
        def free_dofs(nodes2, keep=None):
            d = ext.dofs_of(nodes2)
            f = ext.free[nodes2].copy()
            if keep is not None:
                f &= keep
            return d[f], f
        low, self.f_low = free_dofs(sec.side["low"])
        high, f_high = free_dofs(sec.side["high"])
        assert np.array_equal(self.f_low, f_high)
        parts = [low, high]
        if ring_only:
            self.arc_z = np.flatnonzero(ext.z < (web_half or zl[-1]) + 1e-9)
            keep = np.zeros((1, ext.nz, 1), bool)
            keep[:, self.arc_z] = True
            arc, self.f_arc = free_dofs(sec.inner_arc[1:-1], keep)
            parts.append(arc)
        b = np.concatenate(parts)
        # polar components on the boundary (x, y -> radial, tangential at the node's own angle)
        n = ext.K.shape[0]
        node2 = np.unique(b // (3 * ext.nz))
        psi = np.arctan2(sec.nodes[node2, 1], sec.nodes[node2, 0])
        T = sp.identity(n, format="lil")
        for i, p in zip(node2, psi):
            c, s = np.cos(p), np.sin(p)
            for iz in range(ext.nz):
                x, y = ext.dof(i, iz, 0), ext.dof(i, iz, 1)
                T[x, x], T[x, y], T[y, x], T[y, y] = c, -s, s, c
        T = T.tocsr()
        K = (T.T @ ext.K @ T).tocsr()
        F = (T.T @ F).tocsr()
        isb = np.zeros(n, bool)
        isb[b] = True
        interior = np.flatnonzero(ext.free.ravel() & ~isb)
        t0 = time.time()
        # eliminate the interior of [[K_ii, K_ib, F_i], [., K_bb, 0], [., ., 0]]: K_cut, loads carried to the cut,
        # -C_local
        assert abs(F[b]).max() == 0
        Fi, Kib = F[interior], K[interior][:, b]
        S = condense(sp.bmat([[K[interior][:, interior], Kib, Fi], [Kib.T, K[b][:, b], None],
                              [Fi.T, None, sp.csr_matrix((F.shape[1],) * 2)]]).tocsr(), len(b) + F.shape[1])
        nb = len(b)
        self.S, self.G, self.C_local = S[:nb, :nb], S[:nb, nb:], -S[nb:, nb:]
        log(f"condensed {len(interior)} dofs on {nb} and {F.shape[1]} loads in {time.time() - t0:.1f} s")
        self.n_side = len(low)


class GearCompliance:
    """blocks[(i, j)]: response of the columns of tooth i to unit columns of tooth j (loads, then 2 gauges: right, left)."""

    def __init__(self, tooth, section, slice_edges, blocks, lookup):
        self.tooth, self.sec = tooth, section
        self.edges = np.asarray(slice_edges)
        self.n_slices = len(slice_edges) - 1
        self.n_nodes = len(section.flank["right"])
        self.n_load = self.n_slices * self.n_nodes * 2
        self._blocks, self._lookup = blocks, lookup

    def block(self, i, j):
        return self._lookup(self._blocks, i, j)

    def pattern(self, xi, along=False):
        """(slices, n_load) combination of columns: unit force at roll angle xi of the right flank, per slice: along the normal
        into the material, or along the profile towards the tip."""
        arc = self.sec.flank_arc  # tip first, equally spaced
        ne = (len(arc) - 1) // 2
        s = (arc[0] - self.tooth.arc(xi)) / (arc[0] - arc[-1]) * ne
        e = int(np.clip(np.floor(s), 0, ne - 1))
        n, _ = quad1d(2 * (s - e) - 1)
        d = (self.tooth.towards_tip(xi) if along else self.tooth.inward_normal(xi))[0] * [1, -1]
        col = np.zeros((self.n_nodes, 2))
        col[2 * e : 2 * e + 3] = np.outer(n, d)
        return np.kron(np.eye(self.n_slices), col.ravel())


def cyclic_gear(pitch, z, z_layers):
    """All z pitches equal. Low side of pitch j + 1 is the high side of pitch j; polar components need no rotation."""
    t0 = time.time()
    m = pitch.n_side
    S, G = pitch.S, pitch.G
    a, b, c = S[:m, :m] + S[m:, m:], S[:m, m:], S[m:, :m]
    out = np.zeros((z, G.shape[1], G.shape[1]))
    for k in range(z // 2 + 1):
        w = np.exp(2j * np.pi * k / z)
        A = a + w * b + np.conj(w) * c
        g = G[:m] + np.conj(w) * G[m:]
        if k == 0:
            A, g = A.real, g.real
        R = g.conj().T @ la.solve(A, g, assume_a="pos")
        twice = 1 if k == 0 or 2 * k == z else 2
        for j in range(z):
            out[j] += twice / z * np.real(w**j * R)
    out[0] += pitch.C_local
    log(f"harmonics in {time.time() - t0:.1f} s")
    return GearCompliance(pitch.tooth, pitch.sec, z_layers, out, Circulant(z))


class Circulant:
    """Block of teeth (i, j) when all pitches are equal."""

    def __init__(self, z):
        self.z = z

    def __call__(self, store, i, j):
        return store[(i - j) % self.z]
