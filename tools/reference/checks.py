"""Checks that must hold; prints one line each, exit code 1 if one fails. Add --slot-free for the (slow) body without slots."""

import sys

import numpy as np
import scipy.sparse as sp

import near_field as nf
from contact import STRIP, Pair
from fe import Extruded, condense
from gears import Pitch, cyclic_gear
from make_reference import MESHES, R_RIM, WEB_HALF, Z
from section import Section, section_parameters
from slotted import slotted_gear
from tooth import Tooth

failed = []


def check(name, value, limit):
    ok = abs(value) <= limit
    print(f"{'ok  ' if ok else 'FAIL'} {name}: {value:.3g} (limit {limit:g})", flush=True)
    if not ok:
        failed.append(name)


def geometry(t):
    c = t.check()
    check("tip radius 77.558 mm", c["r_tip"] - 77.558, 5e-4)
    check("root radius 71.708 mm", c["r_root"] - 71.708, 5e-4)
    check("backlash 0.120 mm", c["backlash"] - 0.120, 5e-4)
    check("contact ratio 1.639", c["contact_ratio"] - 1.639, 5e-4)
    check("fillet meets involute, mm", c["join_mm"], 1e-9)
    xi = np.linspace(t.xi_form, t.xi_tip, 9)
    d = (t.flank(xi + 1e-6) - t.flank(xi - 1e-6)) / 2e-6
    check("normal orthogonal to flank", np.abs((d * t.inward_normal(xi)).sum(1) / np.hypot(*d.T)).max(), 1e-8)
    # the normal is tangent to the base circle: lever arm r_base
    p, n = t.flank(xi), t.inward_normal(xi)
    check("lever arm is the base radius, mm", np.abs(np.abs(p[:, 0] * n[:, 1] - p[:, 1] * n[:, 0]) - t.r_base).max(), 1e-9)


def patch_test(t):
    """A linear displacement field must leave no residual inside the curved, extruded mesh."""
    mesh = MESHES["coarse"]
    s = Section(t, R_RIM, [(R_RIM, 35.0, 3)], **section_parameters(mesh))
    e = Extruded(s.nodes, s.quads, [0, 1.0, 3.0], np.ones((len(s.quads), 2), bool))
    A = np.random.default_rng(1).normal(size=(3, 3)) * 1e-3
    x = np.concatenate([np.repeat(s.nodes[:, None], e.nz, 1), np.broadcast_to(e.z[None, :, None], (len(s.nodes), e.nz, 1))], axis=2)
    r = (e.K @ (x @ A.T).ravel()).reshape(x.shape)
    # nodes on the surface: ends of z and section edges that belong to one quad only
    edges = np.sort(np.vstack([s.quads[:, k] for k in ([0, 1], [1, 2], [2, 5], [5, 8], [8, 7], [7, 6], [6, 3], [3, 0])]), axis=1)
    u, n = np.unique(edges, axis=0, return_counts=True)
    surface = np.unique(u[n == 1])
    inner = np.ones(len(s.nodes), bool)
    inner[surface] = False
    check("patch test: residual inside over residual on the surface", np.abs(r[inner][:, 1:-1]).max() / np.abs(r).max(), 1e-11)


def condensation():
    """The sparse Schur complement against the dense one, with a zero block as used for the loads."""
    n, m = 900, 40
    B = sp.random(n, n, 0.004, random_state=1)
    F = sp.random(n, m, 0.05, random_state=2)
    K = sp.bmat([[B @ B.T + 2 * sp.identity(n), F], [F.T, None]]).tocsr()
    D = K.toarray()
    S = D[n:, n:] - D[n:, :n] @ np.linalg.solve(D[:n, :n], D[:n, n:])
    check("condensation against dense algebra, relative", np.abs(condense(K, m) - S).max() / np.abs(S).max(), 1e-12)


def hertz_strip(t):
    """The near field of a wide body: difference of c0 for two half widths follows the strip's logarithm."""
    xi = t.xi(75.0)
    a = nf.c0(t, R_RIM, xi)[0]
    keep, nf.A0 = nf.A0, nf.A0 / 2
    b = nf.c0(t, R_RIM, xi, nf.A0 / 8)[0]
    nf.A0 = keep
    check("c0 by half width against the logarithm, relative", (b - a) / (STRIP * np.log(2)) - 1, 0.01)
    check("c0 with halved element size, relative", nf.c0(t, R_RIM, xi, nf.A0 / 16)[0] / a - 1, 5e-4)


def gears(t, slot_free):
    mesh, z = MESHES["coarse"], MESHES["coarse"]["z"]
    g2 = cyclic_gear(Pitch(t, z, mesh, web_half=WEB_HALF), Z, z)
    n = g2.n_load
    scale = np.abs(g2.block(0, 0)[:n, :n]).max()
    check("reciprocity on one tooth", np.abs(g2.block(0, 0) - g2.block(0, 0).T)[:n, :n].max() / scale, 1e-10)
    check("reciprocity between teeth", np.abs(g2.block(1, 0) - g2.block(0, 1).T)[:n, :n].max() / scale, 1e-10)
    xi0 = 150 * np.sin(np.arccos(2 * t.r_base / 150)) / t.r_base - t.xi_tip
    st = nf.stations(t, xi0)
    near = nf.NearField(t, R_RIM, mesh, st, [nf.c0(t, R_RIM, x)[0] for x in st])
    pair = Pair(g2, g2, near, near, crown_mm=0.0)
    te = []
    for i in range(24):
        s = pair.system(t.pitch_angle * i / 24)
        e, F = pair.solve(s, 200.0, nf.A0)
        te.append(e)
        if i in (0, 6, 12):
            check("force balance, relative", 2 * F.sum() * t.r_base / 200e3 - 1, 1e-9)
    # equal gears without crowning: the mesh cycle is its own mirror image about the pitch point
    te = np.array(te)
    check("TE of two equal gears is even in the angle, relative", np.abs(te[1:] - te[:0:-1]).max() / np.abs(te).max(), 1e-9)
    if slot_free:
        full = slotted_gear(Pitch(t, z, mesh, web_half=WEB_HALF, ring_only=True), Z, z, repeat=1, slots=False,
                            h_web=mesh["h_web"], n_hub=mesh["n_hub_arc"])
        w = np.diff(z) / z[-1]
        for xi in (t.xi(74.0), t.xi(76.5)):
            N = g2.pattern(xi)
            for k in (0, 1, 2):
                a, b = (w @ N @ g.block(k, 0)[:n, :n] @ N.T @ w for g in (g2, full))
                check(f"tooth {k}, slot-free body against cyclic symmetry, relative", b / a - 1, 5e-3)
            for k in (0, 1, 5, 20):
                sa, sb = (g.block(k, 0)[-2:, :n] @ N.T @ w for g in (g2, full))
                ref = np.abs(g2.block(0, 0)[-2:, :n] @ N.T @ w).max()
                check(f"gauges of tooth {k}, difference over largest strain", np.abs(sb - sa).max() / ref, 5e-3)


if __name__ == "__main__":
    t = Tooth()
    geometry(t)
    patch_test(t)
    condensation()
    hertz_strip(t)
    gears(t, "--slot-free" in sys.argv)
    sys.exit(1 if failed else 0)
