"""Thin-rimmed gear with slots in the web: the condensed tooth pitch repeated 57 times on a full mesh of hub and web.

The rim (pitch condensed with `ring_only`) meets the web on the cylinder r_rim, |z| < web_half. The web is coarser around the
circumference there: the rim's nodes follow the web's quadratic trace.
"""

import time

import gmsh
import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from fe import Extruded, condense, quad1d
from gears import GearCompliance, log
from section import weld

N_TRACE = 4  # web elements per tooth pitch at the rim


# radii of thin element rows about the re-entrant corners of hub and web, and of web and rim
HUB_ROWS = {1: (0.0, 0.35, 0.62, 0.85, 1.0), 2: (0.0, 0.5, 1.0)}  # fractions: bore to hub, hub to the free mesh
RIM_ROWS = (0.0, 0.5, 0.82, 1.0)  # free mesh to rim
FREE_IN, FREE_OUT = 36.3, 66.2  # mm, the free mesh lies between


def wedge_quads(r_bore, r_hub, r_rim, n_arc, n_hub, h_web, slots=True, r1=42.0, r2=60.0, corner=3.0, edge_deg=20.0):
    """4-node quads of the wedge 0 to 60 degrees (0 = middle of a spoke, 60 = middle of a slot).

    Free mesh of the web between FREE_IN and FREE_OUT, rings of mapped quads inside and outside.
    """
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    g = gmsh.model.geo
    c = g.addPoint(0, 0, 0)
    P = lambda r, a, h: g.addPoint(r * np.cos(a), r * np.sin(a), 0, h)
    a0, a1, e = 0.0, np.pi / 3, np.deg2rad(edge_deg)
    b = [P(r, a, h_web) for r in (FREE_IN, FREE_OUT) for a in (a0, a1)]
    arc = lambda p, q, m=None: g.addCircleArc(p, m or c, q)
    hub, rim, w0 = arc(b[0], b[1]), arc(b[2], b[3]), g.addLine(b[0], b[2])
    if slots:
        hc = 0.45 * h_web
        i1, i2 = r1 + corner, r2 - corner
        t1, t2 = e + np.arcsin(corner / i1), e + np.arcsin(corner / i2)
        c1, c2 = P(i1, t1, hc), P(i2, t2, hc)
        s = [P(r1, a1, h_web), P(r1, t1, hc), P(np.sqrt(i1**2 - corner**2), e, hc), P(np.sqrt(i2**2 - corner**2), e, hc),
             P(r2, t2, hc), P(r2, a1, h_web)]
        edge = [g.addLine(b[1], s[0]), arc(s[0], s[1]), arc(s[1], s[2], c1), g.addLine(s[2], s[3]), arc(s[3], s[4], c2),
                arc(s[4], s[5]), g.addLine(s[5], b[3])]
    else:
        edge = [g.addLine(b[1], b[3])]
    g.addPlaneSurface([g.addCurveLoop([w0, rim, *[-x for x in edge[::-1]], -hub])])
    g.synchronize()
    for curve, n in ((rim, n_arc), (hub, n_hub)):
        gmsh.model.mesh.setTransfiniteCurve(curve, n // 2 + 1)  # halved again by the subdivision into quads
    for k, v in (("Mesh.RecombineAll", 1), ("Mesh.SubdivisionAlgorithm", 1), ("Mesh.Algorithm", 8), ("Mesh.MeshSizeFactor", 2.0)):
        gmsh.option.setNumber(k, v)
    gmsh.model.mesh.generate(2)
    tag, x, _ = gmsh.model.mesh.getNodes()
    x = x.reshape(-1, 3)[:, :2]
    idx = np.zeros(int(tag.max()) + 1, int)
    idx[tag.astype(int)] = np.arange(len(tag))
    et, _, en = gmsh.model.mesh.getElements(2)
    gmsh.finalize()
    assert list(et) == [3], et
    parts = [(x, idx[en[0].astype(int)].reshape(-1, 4))]
    for radii, n in ((r_bore + (r_hub - r_bore) * np.array(HUB_ROWS[1]), n_hub),
                     (r_hub + (FREE_IN - r_hub) * np.array(HUB_ROWS[2]), n_hub),
                     (FREE_OUT + (r_rim - FREE_OUT) * np.array(RIM_ROWS), n_arc)):
        a = np.linspace(a0, a1, n + 1)
        pts = (radii[:, None, None] * np.stack([np.cos(a), np.sin(a)], -1)).reshape(-1, 2)
        i, j = np.meshgrid(np.arange(len(radii) - 1), np.arange(n), indexing="ij")
        o = (i * (n + 1) + j).ravel()
        parts.append((pts, np.stack([o, o + n + 1, o + n + 2, o + 1], 1)))
    off = np.cumsum([0] + [len(p) for p, _ in parts])
    return np.vstack([p for p, _ in parts]), np.vstack([q + o for (_, q), o in zip(parts, off)])


def nine_node(x, q, circles):
    """Quads with middle nodes; middle nodes of edges that lie on one of the circles are put on it."""
    x = x.copy()
    r = np.hypot(*x.T)
    for c in circles:
        on = np.abs(r - c) < 0.02
        x[on] *= (c / r[on])[:, None]
    r = np.hypot(*x.T)
    p = x[q]
    mids = []
    for a, b in ((0, 1), (1, 2), (2, 3), (3, 0)):
        m = (p[:, a] + p[:, b]) / 2
        for c in circles:
            on = (np.abs(r[q[:, a]] - c) < 1e-6) & (np.abs(r[q[:, b]] - c) < 1e-6)
            m[on] *= (c / np.hypot(*m[on].T))[:, None]
        mids.append(m)
    centre = sum(mids) / 2 - p.sum(axis=1) / 4
    pts = np.stack([p[:, 0], mids[0], p[:, 1], mids[3], centre, mids[1], p[:, 3], mids[2], p[:, 2]], axis=1)
    return pts.reshape(-1, 2), np.arange(9 * len(q)).reshape(-1, 9)


def full_body(z, r_bore, r_hub, r_rim, h_web, n_hub, slots):
    n_arc = z * N_TRACE // 6
    x, q = wedge_quads(r_bore, r_hub, r_rim, n_arc, n_hub, h_web, slots)
    circles = np.concatenate([r_bore + (r_hub - r_bore) * np.array(HUB_ROWS[1]), r_hub + (FREE_IN - r_hub) * np.array(HUB_ROWS[2]),
                              FREE_OUT + (r_rim - FREE_OUT) * np.array(RIM_ROWS)])
    x, q = nine_node(x, q, circles)
    pts, quads, off = [], [], 0
    for k in range(3):
        c, s = np.cos(2 * np.pi * k / 3), np.sin(2 * np.pi * k / 3)
        for sign in (1, -1):
            pts.append((x * [1, sign]) @ np.array([[c, s], [-s, c]]))
            quads.append(q + off)
            off += len(x)
    return weld(np.vstack(pts), np.vstack(quads), 1e-5)


def slotted_gear(pitch, z, z_layers, repeat=19, slots=True, h_web=2.2, n_hub=18, r_bore=25.0, r_hub=35.0, r_rim=68.35,
                 web_half=2.5):
    """pitch: condensed with ring_only. Blocks for loads on teeth 0 .. repeat - 1; the rest by rotation."""
    sec, ext = pitch.sec, pitch.ext
    nodes, quads = full_body(z, r_bore, r_hub, r_rim, h_web, n_hub, slots)
    zl = np.asarray(z_layers)
    rc = np.hypot(*nodes[quads[:, 4]].T)
    active = ~((rc > r_hub)[:, None] & (zl[1:] > web_half + 1e-9)[None, :])
    body = Extruded(nodes, quads, zl, active)
    r = np.hypot(*nodes.T)
    body.free[np.abs(r - r_bore) < 1e-6] = False
    # trace nodes by angle, half element spacing
    n_tr = 2 * N_TRACE * z
    tr = np.flatnonzero(np.abs(r - r_rim) < 1e-6)
    k = np.rint(np.arctan2(nodes[tr, 1], nodes[tr, 0]) / (2 * np.pi / n_tr)).astype(int) % n_tr
    assert len(tr) == n_tr and len(np.unique(k)) == n_tr
    trace = np.empty(n_tr, int)
    trace[k] = tr
    ang = np.arctan2(nodes[trace, 1], nodes[trace, 0])
    assert np.abs(np.angle(np.exp(1j * (ang - 2 * np.pi * np.arange(n_tr) / n_tr)))).max() < 1e-6
    nb, nz = body.K.shape[0], body.nz
    # polar components on the trace
    x0 = body.dofs_of(trace)[:, :, 0].ravel()
    cs, sn = np.repeat(np.cos(ang), nz), np.repeat(np.sin(ang), nz)
    keep = np.ones(nb, bool)
    keep[x0] = keep[x0 + 1] = False
    o = np.flatnonzero(keep)
    T = sp.coo_matrix((np.concatenate([np.ones(len(o)), cs, -sn, sn, cs]),
                       (np.concatenate([o, x0, x0, x0 + 1, x0 + 1]), np.concatenate([o, x0, x0 + 1, x0, x0 + 1]))), shape=(nb, nb)).tocsr()
    Kb = T.T @ body.K @ T
    # boundary of one pitch -> reduced local: (low without corner, high without corner, trace nodes 0..2 N_TRACE, all
    # arc z, 3)
    side_ids = np.argwhere(pitch.f_low)  # (position on the side, iz, comp); position 0 is the corner on r_rim
    corner = (side_ids[:, 0] == 0) & np.isin(side_ids[:, 1], pitch.arc_z)
    na, m = len(pitch.arc_z), pitch.n_side
    n_cut = int((~corner).sum())
    loc_trace = lambda i, iz, c: 2 * n_cut + (i * na + iz) * 3 + c
    n_loc = 2 * n_cut + (2 * N_TRACE + 1) * na * 3
    rows, cols, val = [], [], []
    for s in range(2):
        rows += list(s * m + np.flatnonzero(~corner)); cols += list(s * n_cut + np.arange(n_cut)); val += [1.0] * n_cut
        for i in np.flatnonzero(corner):
            rows.append(s * m + i); cols.append(loc_trace(2 * N_TRACE * s, side_ids[i, 1], side_ids[i, 2])); val.append(1.0)
    psi = np.arctan2(sec.nodes[sec.inner_arc, 1], sec.nodes[sec.inner_arc, 0])[1:-1]
    assert np.all(side_ids[corner, 1] <= pitch.arc_z.max()) and np.array_equal(pitch.arc_z, np.arange(na))
    for i, (a, iz, c) in enumerate(np.argwhere(pitch.f_arc)):
        t = (psi[a] / pitch.tooth.pitch_angle + 0.5) * N_TRACE
        e = int(np.clip(np.floor(t), 0, N_TRACE - 1))
        n, _ = quad1d(2 * (t - e) - 1)
        for b in range(3):
            rows.append(2 * m + i); cols.append(loc_trace(2 * e + b, iz, c)); val.append(n[b])
    Q = sp.coo_matrix((val, (rows, cols)), shape=(2 * m + int(pitch.f_arc.sum()), n_loc)).tocsr()
    S = Q.T @ (Q.T @ pitch.S).T  # symmetric
    S = (S + S.T) / 2
    G = Q.T @ pitch.G
    # body (hub and web) on its trace
    order = np.concatenate([body.dofs_of(trace[2 * N_TRACE * j - N_TRACE + np.arange(2 * N_TRACE)], pitch.arc_z) for j in range(z)])
    kept = np.concatenate([body.free[trace[2 * N_TRACE * j - N_TRACE + np.arange(2 * N_TRACE)]][:, pitch.arc_z] for j in range(z)])
    t = order[kept]  # pitch by pitch: N_TRACE * 2 nodes, arc z, component
    inner = body.free.ravel().copy()
    inner[t] = False
    i = np.flatnonzero(inner)
    t0 = time.time()
    Kb = Kb.tocsr()
    M = condense(sp.bmat([[Kb[i][:, i], Kb[i][:, t]], [Kb[t][:, i], Kb[t][:, t]]]).tocsr(), len(t))
    log(f"slots={slots}: {len(quads)} body quads, {len(i)} dofs condensed on {len(t)} in {time.time() - t0:.1f} s")
    # rim alone: cyclic. Unknowns of a pitch: its low cut and its first 2 N_TRACE trace nodes; local = E0 own + E1 of
    # the next
    f_tr = np.ones((2 * N_TRACE + 1, na, 3), bool)
    f_tr[:, 0, 2] = False  # plane of symmetry
    n_own, n_end = int(f_tr[:-1].sum()), int(f_tr[-1].sum())
    live = np.concatenate([np.ones(2 * n_cut, bool), f_tr.ravel()])
    S, G = S[np.ix_(live, live)], G[live]
    assert n_own * z == len(t)
    E0, E1 = np.zeros((2, 2 * n_cut + n_own + n_end, n_cut + n_own))
    E0[:n_cut, :n_cut] = np.eye(n_cut)
    E1[n_cut : 2 * n_cut, :n_cut] = np.eye(n_cut)
    E0[2 * n_cut : 2 * n_cut + n_own, n_cut:] = np.eye(n_own)
    E1[2 * n_cut + n_own :, n_cut : n_cut + n_end] = np.eye(n_end)
    nl = G.shape[1]
    S_ring, G_ring, C_ring = np.zeros((z, n_own, n_own)), np.zeros((z, n_own, nl)), np.zeros((z, nl, nl))
    for k in range(z // 2 + 1):
        w = np.exp(2j * np.pi * k / z)
        E = E0 + w * E1
        A, g = E.conj().T @ (S @ E), E.conj().T @ G
        X = la.solve(A[:n_cut, :n_cut], np.hstack([A[:n_cut, n_cut:], g[:n_cut]]), assume_a="her")
        At = A[n_cut:, n_cut:] - A[n_cut:, :n_cut] @ X[:, :n_own]
        gt = g[n_cut:] - A[n_cut:, :n_cut] @ X[:, n_own:]
        c = g[:n_cut].conj().T @ X[:, n_own:]
        twice = 1 if k == 0 or 2 * k == z else 2
        for j in range(z):
            f = twice / z * w**j
            S_ring[j] += (f * At).real
            G_ring[j] += (f * gt).real
            C_ring[j] += (f * c).real
    M = M.reshape(z, n_own, z, n_own)
    for a in range(z):
        for b in range(z):
            M[a, :, b] += S_ring[(a - b) % z]
    M = M.reshape(z * n_own, z * n_own)
    M = la.cho_factor((M + M.T) / 2, lower=True, overwrite_a=True, check_finite=False)
    # loads of one tooth span a small space on the trace: compress
    scale = np.ones(nl)
    scale[-2:] = np.abs(G_ring[..., :-2]).max() / np.abs(G_ring[..., -2:]).max()
    U, sv, Vt = np.linalg.svd((G_ring * scale).reshape(z * n_own, nl), full_matrices=False)
    rank = int((sv > 1e-8 * sv[0]).sum())
    U, back = U[:, :rank].reshape(z, n_own, rank), (sv[:rank, None] * Vt[:rank]) / scale
    turned = [np.roll(U, j, axis=0).reshape(z * n_own, rank) for j in range(z)]
    near, gauges = {}, np.zeros((z, repeat, 2, nl))
    for j in range(repeat):
        u = la.cho_solve(M, turned[j], check_finite=False)
        for i in range(z):
            R = turned[i].T @ u
            gauges[i, j] = back[:, -2:].T @ R @ back + C_ring[(i - j) % z, -2:]
            if min((i - j) % z, (j - i) % z) <= 3:
                near[(i, j)] = back.T @ R @ back + C_ring[(i - j) % z]
        near[(j, j)] = near[(j, j)] + pitch.C_local
        gauges[j, j] += pitch.C_local[-2:]
    log(f"rank {rank}, rim and {repeat} teeth solved in {time.time() - t0:.1f} s")

    return GearCompliance(pitch.tooth, sec, z_layers, (near, gauges), Repeating(z, repeat))


class Repeating:
    """Block of teeth (i, j) when the gear repeats after `repeat` teeth. Distant teeth: gauge rows only, the rest is NaN."""

    def __init__(self, z, repeat):
        self.z, self.repeat = z, repeat

    def __call__(self, store, i, j):
        near, gauges = store
        turn = (j % self.z) // self.repeat * self.repeat
        i, j = (i - turn) % self.z, (j - turn) % self.z
        if (i, j) in near:
            return near[(i, j)]
        b = np.full((gauges.shape[-1],) * 2, np.nan)
        b[-2:] = gauges[i, j]
        return b
