"""Cross-section mesh of one tooth pitch: 9-node quadrilaterals in mapped blocks, mirrored about the tooth centre line.

Half of the pitch (tooth centre line to middle of the tooth space):

    A--B          A tip centre, B tip corner
    |   \\  1      1 tooth block       (A B F G), B-F is the flank and most of the fillet
    G----F---C    2 below the tooth   (G F H E)
    | 2  | 3 |    3 below the space   (F C D H), F-C is the rest of the fillet and the root arc
    E----H---D    E-H-D is the arc r_inner
"""

import numpy as np
from scipy.spatial import cKDTree


def polar(r, t):
    return np.column_stack([r * np.cos(t), r * np.sin(t)])


def spread(p, n):
    """n + 1 points of the line p at equal arc length."""
    s = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(p, axis=0).T))])
    t = np.linspace(0, s[-1], n + 1)
    return np.column_stack([np.interp(t, s, p[:, 0]), np.interp(t, s, p[:, 1])])


def graded(n, ratio):
    """n elements on [0, 1], last length = ratio * first, each with its middle point: 2 n + 1 values."""
    h = np.geomspace(1, ratio, n)
    x = np.concatenate([[0], np.cumsum(h)]) / h.sum()
    return np.sort(np.concatenate([x, (x[1:] + x[:-1]) / 2]))


def line(a, b, t):
    return a + np.outer(t, np.asarray(b) - a)


def transfinite(bottom, top, left, right):
    """Coons patch; bottom/top (n, 2) run along i, left/right (m, 2) along j; result (n, m, 2)."""
    n, m = len(bottom), len(left)
    # blending by mean chord parameter, so that the grading of the edges is kept inside
    def par(p):
        s = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(p, axis=0).T))])
        return s / s[-1]
    u = ((par(bottom) + par(top)) / 2)[:, None, None]
    v = ((par(left) + par(right)) / 2)[None, :, None]
    return ((1 - v) * bottom[:, None] + v * top[:, None] + (1 - u) * left[None] + u * right[None]
            - (1 - u) * (1 - v) * bottom[0] - u * (1 - v) * bottom[-1] - (1 - u) * v * top[0] - u * v * top[-1])


def grid_quads(n, m):
    """9-node quads (tensor order a + 3 b, a along i) of an n x m point grid stored row by row (i, j)."""
    q = []
    for i in range(0, n - 2, 2):
        for j in range(0, m - 2, 2):
            q.append([(i + a) * m + (j + b) for b in range(3) for a in range(3)])
    return np.array(q)


def merge(blocks, tol=1e-7):
    """Join point grids [(points (n, m, 2), mirrored)] into nodes and quads; quads are turned to positive area."""
    pts, quads, off = [], [], 0
    for g in blocks:
        n, m = g.shape[:2]
        pts.append(g.reshape(-1, 2))
        quads.append(grid_quads(n, m) + off)
        off += n * m
    return weld(np.vstack(pts), np.vstack(quads), tol)


def weld(pts, quads, tol=1e-7):
    parent = np.arange(len(pts))
    for i, j in sorted(cKDTree(pts).query_pairs(tol)):
        parent[j] = min(parent[j], parent[i])
    while np.any(parent != parent[parent]):
        parent = parent[parent]
    keep, inv = np.unique(parent, return_inverse=True)
    pts, quads = pts[keep], inv[quads]
    c = pts[quads]
    e1, e2 = c[:, 2] - c[:, 0], c[:, 6] - c[:, 0]
    flip = e1[:, 0] * e2[:, 1] - e1[:, 1] * e2[:, 0] < 0
    quads[flip] = quads[flip][:, [2, 1, 0, 5, 4, 3, 8, 7, 6]]
    return pts, quads


def section_parameters(mesh):
    """The entries of a mesh table that shape the section."""
    keys = ("n_flank", "n_fillet", "n_half", "n_depth", "n_space", "grade_half", "grade_depth")
    return {k: mesh[k] for k in keys if k in mesh}


class Section:
    """Nodes, quads, and the named node lines of one pitch. Lines are ordered node indices."""

    def __init__(self, tooth, r_inner, body_radii=(), n_flank=12, n_fillet=5, n_half=4, n_depth=4, n_space=4,
                 split_deg=55.0, g_radius=None, grade_half=0.45, grade_depth=1.6):
        t = tooth
        self.tooth, self.r_inner = t, r_inner
        half_pitch = t.pitch_angle / 2
        fil, s_fil, th = t.fillet_dense()
        iF = np.searchsorted(th, np.deg2rad(split_deg))
        F = fil[iF]
        # B -> F
        arc = np.linspace(t.arc(t.xi_tip), t.arc(t.xi_form), 2 * n_flank + 1)
        BF = np.vstack([t.flank(t.xi_of_arc(arc)), spread(fil[: iF + 1], 2 * n_fillet)[1:]])
        BF[-1] = F
        self.flank_arc = arc  # tip first
        # F -> C
        psi0 = np.arctan2(fil[-1, 1], fil[-1, 0])
        rest = np.vstack([fil[iF:], polar(t.r_root, np.linspace(psi0, half_pitch, 400))[1:]])
        FC = spread(rest, 2 * n_space)
        FC[0], FC[-1] = F, polar(t.r_root, half_pitch)[0]
        B, C = BF[0], FC[-1]
        G = np.array([g_radius or (t.r_root - 0.5 * (t.r_root - r_inner)), 0.0])
        half = graded(n_half, grade_half)
        psiB = np.arctan2(B[1], B[0])
        AB = polar(t.r_tip, half * psiB)
        AB[-1] = B
        GF = line(G, F, half)
        tH = half_pitch * 0.55
        EH = polar(r_inner, half * tH)
        HD = polar(r_inner, tH + (half_pitch - tH) * np.linspace(0, 1, 2 * n_space + 1))
        E, H, D = EH[0], EH[-1], HD[-1]
        depth = graded(n_depth, grade_depth)
        # centre line spacing follows the flank spacing
        sBF = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(BF, axis=0).T))])
        AG = line(np.array([t.r_tip, 0.0]), G, sBF / sBF[-1])
        GE, FH, CD = line(G, E, depth), line(F, H, depth), line(C, D, depth)
        blocks = [transfinite(AB, GF, AG, BF), transfinite(GF, EH, GE, FH), transfinite(FC, HD, FH, CD)]
        # body below r_inner: radial lines of the arc continued
        ang = np.concatenate([half * tH, (tH + (half_pitch - tH) * np.linspace(0, 1, 2 * n_space + 1))[1:]])
        for r0, r1, n in body_radii:
            # rows get thin at both ends: re-entrant corners sit where web, rim and hub meet
            e = r0 + (r1 - r0) * (1 - np.cos(np.pi * np.linspace(0, 1, n + 1))) / 2
            rr = np.insert(e, range(1, n + 1), (e[1:] + e[:-1]) / 2)
            blocks.append(np.stack([polar(r, ang) for r in rr], axis=1))
        blocks += [b * np.array([1.0, -1.0]) for b in blocks]
        self.nodes, self.quads = merge(blocks)
        self.tree = cKDTree(self.nodes)
        r = np.hypot(*self.nodes.T)
        psi = np.arctan2(self.nodes[:, 1], self.nodes[:, 0])
        self.side = {}
        for name, sign in (("low", -1), ("high", 1)):
            ids = np.flatnonzero(np.abs(psi - sign * half_pitch) < 1e-9)
            self.side[name] = ids[np.argsort(r[ids])]
        ids = np.flatnonzero(np.abs(r - r_inner) < 1e-7)
        self.inner_arc = ids[np.argsort(psi[ids])]
        # right flank is the clockwise one: negative y. "left" is its mirror
        flip = np.array([1.0, -1.0])
        self.profile = {"left": self.find(np.vstack([BF, FC[1:]])), "right": self.find(np.vstack([BF, FC[1:]]) * flip)}
        self.flank = {k: v[: 2 * n_flank + 1] for k, v in self.profile.items()}
        self.s30 = sBF[2 * n_flank] + np.interp(np.deg2rad(30.0), th, s_fil)  # arc length from the tip corner to the 30 degree point

    def find(self, pts):
        d, i = self.tree.query(pts)
        assert d.max() < 1e-6, d.max()
        return i

    def element_centre_radius(self):
        return np.hypot(*self.nodes[self.quads[:, 4]].T)
