"""Static transmission error of a solid spur pair in plane strain, contact resolved along the flank, on and off the path of contact.

    python off_path.py compute --h 0.01 --near 0.125 --cache DIR    flank elements of 0.01 mm (0.0025 mm at the tip), other teeth from 0.125 mm
    python off_path.py compute --h 0.02 --near 0.125 --cache DIR    a coarser flank ...
    python off_path.py compute --h 0.02 --near 0.25 --cache DIR     ... and coarser teeth and body, for the error estimate
    python off_path.py write --cache DIR --out ../../reference

Two equal gears: z 50, m 3 mm, 20 degrees, x 0, face width 20 mm, bore radius 30 mm fixed, E 206 GPa, nu 0.3, centre distance
150.02 mm. Influence functions of the right flank of one tooth on itself and on its neighbours: triangles with quadratic
displacement on the whole cross-section, pressure by linear hats at the nodes of the flank. Contact: unilateral, frictionless,
every node of the flank of one gear against the involute of the other, from the true position of the rigid gears, force along the
mating flank's normal. Sharp tip corner. N, mm, rad.
"""

import argparse
import time
from pathlib import Path

import numpy as np
import scipy.sparse as sp
from scipy.interpolate import CubicSpline
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

from tooth import Tooth

E_MPA, NU, BORE, WIDTH, CENTRE = 206e3, 0.3, 30.0, 20.0, 150.02
TORQUES, POINTS, REACH, PATHS = (170, 340), 40, 2, ("line-of-action", "extended")
PATCH = 0.6  # mm of flank on either side of the nearest point that may touch
FLIP = np.array([1.0, -1.0])


def turned(p, angle):
    c, s = np.cos(angle), np.sin(angle)
    return p @ np.array([[c, s], [-s, c]])


def flank_nodes(tooth, h):
    """Arc lengths of the nodes: elements of about h, of h/4 at the tip and where a mate's tip edge may touch."""
    s = lambda xi: tooth.arc(xi)
    start = np.sqrt(CENTRE**2 - 4 * tooth.r_base**2) / tooth.r_base - tooth.xi_tip
    cuts = [s(tooth.xi_form), s(start) - 0.1, s(start + 0.024) + 0.05, s(tooth.xi_tip) - 0.15, s(tooth.xi_tip)]
    parts = [np.linspace(a, b, 1 + int(np.ceil((b - a) / (h / 4 if n % 2 else h)))) for n, (a, b) in enumerate(zip(cuts, cuts[1:]))]
    return np.concatenate([parts[0]] + [q[1:] for q in parts[1:]])


def mesh(tooth, h, near):
    """Points, triangles of the gear; flank nodes of the right flank of tooth 0, other teeth with elements from `near`."""
    import gmsh

    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    geo = gmsh.model.geo
    arc = flank_nodes(tooth, h)
    half = tooth.pitch_angle / 2
    fillet = tooth.fillet_dense(401)[0][::20]
    polar = lambda r, a: np.array([r * np.cos(a), r * np.sin(a)])
    psi_root = np.arctan2(fillet[-1, 1], fillet[-1, 0])
    flank = tooth.flank(np.linspace(tooth.xi_form, tooth.xi_tip, 25))
    psi_tip = np.arctan2(flank[-1, 1], flank[-1, 0])
    first, last, curves, fine = None, None, [], []
    for k in range(tooth.z):
        right = tooth.flank(tooth.xi_of_arc(arc)) if k == 0 else flank
        pieces = [[polar(tooth.r_root, -half), polar(tooth.r_root, -(half + psi_root) / 2), fillet[-1] * FLIP],
                  fillet[::-1] * FLIP, right * FLIP,
                  [polar(tooth.r_tip, a) for a in np.linspace(-psi_tip, psi_tip, 5)],
                  flank[::-1], fillet,
                  [fillet[-1], polar(tooth.r_root, (half + psi_root) / 2), polar(tooth.r_root, half)]]
        for n, piece in enumerate(pieces):
            p = turned(np.array(piece), k * tooth.pitch_angle)
            ids = [last or geo.addPoint(*p[0], 0)]
            first = first or ids[0]
            ids += [geo.addPoint(*q, 0) for q in p[1:-1]]
            ids.append(first if k == tooth.z - 1 and n == len(pieces) - 1 else geo.addPoint(*p[-1], 0))
            last = ids[-1]
            if k == 0 and n == 2:
                made = [geo.addLine(a, b) for a, b in zip(ids, ids[1:])]
                fine += made
                for c in made:
                    geo.mesh.setTransfiniteCurve(c, 2)
            else:
                made = [geo.addSpline(ids)]
            curves += made
    centre = geo.addPoint(0, 0, 0)
    ring = [geo.addPoint(*polar(BORE, a), 0) for a in np.arange(4) * np.pi / 2]
    bore = [geo.addCircleArc(ring[i], centre, ring[(i + 1) % 4]) for i in range(4)]
    geo.addPlaneSurface([geo.addCurveLoop(curves), geo.addCurveLoop(bore)])
    geo.synchronize()
    for name in ("MeshSizeExtendFromBoundary", "MeshSizeFromPoints"):
        gmsh.option.setNumber(f"Mesh.{name}", 0)
    field = gmsh.model.mesh.field
    length = np.diff(arc)
    fields = []
    for size, chosen in ((h / 4, length < 0.6 * h), (h, length >= 0.6 * h)):
        d = field.add("Distance")
        field.setNumbers(d, "CurvesList", [c for c, yes in zip(fine, chosen) if yes])
        field.setNumber(d, "Sampling", 3)
        fields.append(field.add("MathEval"))
        field.setString(fields[-1], "F", f"{size} + 0.14*F{d}")
    teeth = field.add("MathEval")  # teeth beside tooth 0, other teeth, body
    rim = tooth.r_root - 1.0
    field.setString(teeth, "F", f"{near} + {0.24 * near}*Sqrt((x-{tooth.r})^2+y^2)*Step(Sqrt((x-{tooth.r})^2+y^2)-22)"
                                f" + {0.48 * near}*Step({rim}-Sqrt(x*x+y*y))*({rim}-Sqrt(x*x+y*y))")
    both = field.add("Min")
    field.setNumbers(both, "FieldsList", [*fields, teeth])
    field.setAsBackgroundMesh(both)
    gmsh.model.mesh.generate(2)
    tag, x, _ = gmsh.model.mesh.getNodes()
    order = np.argsort(tag)
    index = np.zeros(int(tag.max()) + 1, int)
    index[tag[order].astype(int)] = np.arange(len(tag))
    tri = index[gmsh.model.mesh.getElements(2)[2][0].astype(int)].reshape(-1, 3)
    x = x.reshape(-1, 3)[order, :2]
    gmsh.finalize()
    used, tri = np.unique(tri, return_inverse=True)
    return x[used], tri.reshape(-1, 3), arc


def influence(h, near):
    """Flank nodes (arc length) and G[j] (n, 2, n, 2): displacement on tooth j under a unit force per mm on a hat of tooth 0;
    components along the inward normal and towards the tip. j = -REACH..REACH."""
    from skfem import Basis, BilinearForm, ElementTriP2, ElementVector, MeshTri
    from skfem.helpers import ddot, eye, sym_grad, trace

    tooth = Tooth(z=50, m=3.0, x=0.0)
    x, tri, arc = mesh(tooth, h, near)
    m = MeshTri(np.ascontiguousarray(x.T), np.ascontiguousarray(tri.T))
    basis = Basis(m, ElementVector(ElementTriP2()), intorder=4)
    lame, mu = E_MPA * NU / ((1 + NU) * (1 - 2 * NU)), E_MPA / (2 * (1 + NU))

    @BilinearForm
    def stiffness(u, v, w):
        e = sym_grad(u)
        return ddot(2 * mu * e + eye(lame * trace(e), 2), sym_grad(v))

    K = stiffness.assemble(basis).tocsc()
    free = np.flatnonzero(np.hypot(*basis.doflocs) > BORE + 1e-3)
    factor = splu(K[free][:, free], permc_spec="MMD_AT_PLUS_A", options=dict(SymmetricMode=True), diag_pivot_thresh=0.0)

    xi = tooth.xi_of_arc(arc)
    inward = tooth.inward_normal(xi) * FLIP
    tip = np.column_stack([inward[:, 1], -inward[:, 0]])
    tip *= np.sign((tip * tooth.flank(xi) * FLIP).sum(1))[:, None]
    axes = np.stack([inward, tip], 1)  # (n, component, xy)
    n = len(arc)
    edge_of = {tuple(sorted(e)): i for i, e in enumerate(m.facets.T)}
    dist, vertex = cKDTree(m.p.T).query(tooth.flank(xi) * FLIP)
    assert dist.max() < 1e-9
    R = np.zeros((K.shape[0], n, 2))
    for i in range(n):
        length = 0.0
        for j in (i - 1, i + 1):
            if 0 <= j < n:
                e = edge_of[tuple(sorted((vertex[i], vertex[j])))]
                step = abs(arc[j] - arc[i])
                length += step / 2
                for xy in range(2):
                    R[basis.nodal_dofs[xy, vertex[i]], i] += step / 6 * axes[i, :, xy]
                    R[basis.facet_dofs[xy, e], i] += step / 3 * axes[i, :, xy]
        R[:, i] /= length
    R = sp.csc_matrix(R.reshape(len(R), -1))
    others = {}
    for k in range(-REACH, REACH + 1):
        if k:
            p = turned(m.p.T, -k * tooth.pitch_angle)
            r, psi = np.hypot(*p.T), np.arctan2(p[:, 1], p[:, 0])
            on = np.flatnonzero((r > tooth.r_form - 1e-6) & (r < tooth.r_tip + 1e-6))
            s = tooth.arc(tooth.xi(np.minimum(r[on], tooth.r_tip)))
            want = -(tooth.half_base - (tooth.xi_of_arc(s) - np.arctan(tooth.xi_of_arc(s))))
            keep = np.abs(psi[on] - want) * r[on] < 2e-3
            o = np.argsort(s[keep])
            others[k] = on[keep][o], s[keep][o]
            assert len(others[k][0]) > 15, len(others[k][0])
    G = {k: np.zeros((n, 2, 2 * n)) for k in range(-REACH, REACH + 1)}
    for c in range(0, 2 * n, 100):
        block = slice(c, min(c + 100, 2 * n))
        u = np.zeros((K.shape[0], block.stop - c))
        u[free] = factor.solve(R[free][:, block].toarray())
        G[0][:, :, block] = (R.T @ u).reshape(n, 2, -1)
        for k, (nodes, s) in others.items():
            d = u[basis.nodal_dofs[:, nodes]]  # (xy, node, load)
            frame = np.stack([turned(axes[:, a], k * tooth.pitch_angle) for a in range(2)], 1)
            at = CubicSpline(s, d, axis=1)(arc)
            G[k][:, :, block] = np.einsum("nax,xnl->nal", frame, at)
    G = {k: v.reshape(2 * n, 2 * n) for k, v in G.items()}
    for k in range(1, REACH + 1):  # reciprocity between neighbours, up to interpolation
        mean = (G[k] + G[-k].T) / 2
        print(f"tooth {k}: reciprocity {np.abs(G[k] - G[-k].T).max() / np.abs(mean).max():.1e}")
        G[k], G[-k] = mean, mean.T
    print(f"h {h}: {len(x)} vertices, {K.shape[0]} unknowns, {n} flank nodes, "
          f"asymmetry {np.abs(G[0] - G[0].T).max() / np.abs(G[0]).max():.1e}")
    return dict(arc=arc, unknowns=K.shape[0], **{f"G{k}": v for k, v in G.items()})


def nodes_against_flank(tooth, xi_tip_gear, xi_mate, xi):
    """Points `xi` of a flank that meets the line of action at xi_tip_gear, against the mating involute that does at xi_mate:
    gap, foot roll angle, turn of the mating normal against the point's own towards its tip, lever arm about the point's gear."""
    rb = tooth.r_base
    line = np.sqrt(CENTRE**2 - 4 * rb**2)
    phi = xi - xi_tip_gear
    q = rb * np.array([np.sin(phi) - xi * np.cos(phi), -np.cos(phi) - xi * np.sin(phi)])
    p = q + np.array([[line], [2 * rb]])
    along = np.sqrt((p**2).sum(0) / rb**2 - 1)
    psi = np.arctan2(p[0], p[1]) - np.arctan(along)
    open_angle = psi + along - xi_mate
    arm = -q[0] * np.sin(psi) - q[1] * np.cos(psi)
    return rb * open_angle, along - open_angle, phi + psi, arm


class Pairs:
    def __init__(self, data):
        self.tooth = Tooth(z=50, m=3.0, x=0.0)
        self.arc, self.G = data["arc"], {k: data[f"G{k}"] for k in range(-REACH, REACH + 1)}
        self.alpha_w = np.arccos(2 * self.tooth.r_base / CENTRE)
        self.line = CENTRE * np.sin(self.alpha_w)

    def shares(self, xi):
        """Rows over the flank hats with the first moment kept."""
        s = np.clip(self.tooth.arc(xi), self.arc[0], self.arc[-1])
        i = np.clip(np.searchsorted(self.arc, s, side="right") - 1, 0, len(self.arc) - 2)
        w = (s - self.arc[i]) / (self.arc[i + 1] - self.arc[i])
        rows = np.arange(len(xi))
        return sp.csr_matrix((np.concatenate([1 - w, w]), (np.tile(rows, 2), np.concatenate([i, i + 1]))), shape=(len(xi), len(self.arc)))

    def lines(self, theta, extended):
        """Candidate nodes of all pairs: dict per pair."""
        t, out = self.tooth, []
        for p in range(-4, 5):
            x1 = np.tan(self.alpha_w) + theta - p * t.pitch_angle
            x2 = self.line / t.r_base - x1
            beyond = max(x1, x2) - t.xi_tip
            if beyond > (0.35 * t.pitch_angle if extended else 0):
                continue
            own = 0 if x1 > x2 else 1  # the gear whose tip is nearer carries the nodes
            xo, xm = (x1, x2) if own == 0 else (x2, x1)
            s = self.arc
            near = np.abs(s - t.arc(min(xo, t.xi_tip))) < PATCH
            xi = t.xi_of_arc(s[near])
            gap, foot, tilt, arm = nodes_against_flank(t, xo, xm, xi)
            keep = foot > t.xi_form
            on = np.zeros((keep.sum(), len(s)))
            on[np.arange(keep.sum()), np.flatnonzero(near)[keep]] = 1

            def rows(w, normal, tangential):
                w = sp.csr_matrix(w).tocoo()
                r = np.concatenate([w.row, w.row])
                c = np.concatenate([2 * w.col, 2 * w.col + 1])
                v = np.concatenate([w.data * normal[w.row], w.data * tangential[w.row]])
                return sp.csr_matrix((v, (r, c)), shape=(w.shape[0], 2 * len(s)))
            tilt, gap, foot, arm = tilt[keep], gap[keep], foot[keep], arm[keep]
            one = np.ones_like(tilt)
            shares = [None, None]
            shares[own] = rows(on, np.cos(tilt), np.sin(tilt))
            shares[1 - own] = rows(self.shares(foot), one, 0 * one)
            arms = [None, None]
            arms[own], arms[1 - own] = arm, t.r_base * one
            out.append(dict(pair=p, gap=gap, shares=shares, closing=arms[1] / t.r_base, arm=arms[1], beyond=beyond))
        return out

    def solve(self, theta, torque, extended):
        """TE in mm and force per pair in N."""
        L = self.lines(theta, extended)
        size = [len(l["gap"]) for l in L]
        start = np.concatenate([[0], np.cumsum(size)])
        C = np.zeros((start[-1],) * 2)
        for i, a in enumerate(L):
            for j, b in enumerate(L):
                d = b["pair"] - a["pair"]
                if abs(d) > REACH:
                    continue
                # gear 1: tooth p; gear 2: tooth -p. G[k]: response on tooth k of a load on tooth 0
                C[start[i]:start[i + 1], start[j]:start[j + 1]] = (
                    a["shares"][0] @ (self.G[-d] @ b["shares"][0].T.toarray())
                    + a["shares"][1] @ (self.G[d] @ b["shares"][1].T.toarray()))
        C = (C + C.T) / 2 / WIDTH  # forces in N on the whole width
        gap, w, arm = (np.concatenate([l[k] for l in L]) for k in ("gap", "closing", "arm"))
        moment = torque * 1e3
        active = gap < gap.min() + 2e-3
        for _ in range(200):
            A = np.flatnonzero(active)
            M = np.block([[C[np.ix_(A, A)], -w[A, None]], [arm[None, A], np.zeros((1, 1))]])
            sol = np.linalg.solve(M, np.concatenate([-gap[A], [moment]]))
            F = np.zeros_like(gap)
            F[A], x = sol[:-1], sol[-1]
            g = gap + C @ F - w * x
            new = np.where(active, F > 0, g < -1e-12)
            if (new == active).all():
                break
            active = new
        else:
            raise RuntimeError("active set did not settle")
        return -x, {l["pair"]: F[start[i]:start[i + 1]].sum() for i, l in enumerate(L)}, active.sum()


def compute(h, near, cache):
    cache.mkdir(parents=True, exist_ok=True)
    name = f"{h:g}_{near:g}.npz"
    file = cache / f"influence_{name}"
    if not file.exists():
        t0 = time.time()
        np.savez(file, **influence(h, near))
        print(f"influence functions: {time.time() - t0:.0f} s")
    data = np.load(file)
    pairs = Pairs(data)
    angle = pairs.tooth.pitch_angle * np.arange(POINTS) / POINTS
    te = {f"{path}_{T}": np.array([pairs.solve(a, T, path == "extended")[0] for a in angle]) for path in PATHS for T in TORQUES}
    np.savez(cache / f"te_{name}", angle=angle, unknowns=data["unknowns"], **te)
    for T in TORQUES:
        for path in PATHS:
            v = te[f"{path}_{T}"] * 1e3
            print(f"{T} N m, {path}: mean {v.mean():.4f} um, peak to peak {np.ptp(v):.4f} um")


def write(cache, out):
    """Records of both paths, finest mesh, with the changes from the other meshes as error estimate."""
    runs = {tuple(float(v) for v in f.stem.split("_")[1:]): np.load(f) for f in sorted(cache.glob("te_*.npz"))}
    best = min(runs)
    fine = runs[best]
    # flank: from the mesh of twice the element; teeth and body: between two meshes with the same flank
    flank = runs[2 * best[0], best[1]]
    body = runs[2 * best[0], 2 * best[1]]
    for path in PATHS:
        folder = out / f"solid_{path.replace('-', '_')}"
        folder.mkdir(parents=True, exist_ok=True)
        te = {T: fine[f"{path}_{T}"] * 1e3 for T in TORQUES}
        largest = lambda figure: sum(max(abs(figure(a[f"{path}_{T}"]) - figure(b[f"{path}_{T}"])) * 1e3 for T in TORQUES)
                                     for a, b in ((fine, flank), (flank, body)))
        worst = {T: sum(np.abs(a[f"{path}_{T}"] / b[f"{path}_{T}"] - 1).max() for a, b in ((fine, flank), (flank, body)))
                 for T in TORQUES}
        n = 50 * POINTS
        rows = [",".join(["angle_deg"] + [f"te_um_{T}Nm" for T in TORQUES])]
        for k in range(n):
            rows.append(f"{360 * k / n:.6f}," + ",".join(f"{te[T][k % POINTS]:.6g}" for T in TORQUES))
        (folder / "data.csv").write_text("\n".join(rows) + "\n")
        (folder / "record.toml").write_text(f'''title = "Solid pair 50/50, m 3 mm, plane strain, path = {path}"
kind = "computed"
source = "computed with tools/reference/off_path.py (Python, own finite elements and contact solver), no code shared with gearmesh; nothing in it is measured"
method = """
Quasi-static, frictionless, plane strain, no misalignment, no microgeometry, sharp tip corners. Influence functions of one flank on
itself and on its neighbours (teeth -2 to 2): triangles with quadratic displacement on the whole cross-section, {best[0]:g} mm long on
the flank, {best[0] / 4:g} mm at its tip and where tip edges touch it, pressure by linear hats at its nodes. Unilateral contact of every node within {PATCH} mm of the nearest point with the
involute of the mate, true position of the rigid gears, force along the mating flank's normal with its own lever arms, torque given.
{"Tip edges touch before and after the path of contact." if path == "extended" else "Pairs exist on the path of contact only, so the TE jumps where one enters or leaves."}"""
command = "python tools/reference/off_path.py (see its head)"
date = {time.strftime("%Y-%m-%d")}
angle_origin = "driver angle 0: the unmodified right flanks of tooth 0 of both gears touch at the pitch point"
torques_Nm = [{", ".join(map(str, TORQUES))}]
points_per_revolution = {n}
points_per_pitch = {POINTS}
periodicity = "computed over one tooth pitch and repeated 50 times"

[conventions]
te = "TE = r_b2 theta2 - r_b1 theta1, each angle positive in its gear's own sense of turning; 0 where unmodified flanks touch without load; negative under load"
torque = "torque on the driven gear"
units = "angle in degrees, TE in micrometres, torque in newton metres"

[gears]
both = "z 50, m 3 mm, 20 degrees, x 0, addendum 1, dedendum 1.25, rack tip radius 0.38, face width {WIDTH:g} mm, solid, bore radius {BORE:g} mm fixed"
centre_distance_mm = {CENTRE}

[material]
youngs_modulus_GPa = {E_MPA / 1e3:g}
poisson_ratio = {NU}

[mesh]
flank_mm = {best[0]:g}
flank_at_tip_mm = {best[0] / 4:g}
other_teeth_mm = {best[1]:g}
unknowns = {fine["unknowns"]}

[uncertainty]
# change when the flank elements halve, plus change when all other elements halve: numerical solution of the stated
# model only
te_mean_um = {largest(np.mean):.4f}
te_peak_to_peak_um = {largest(np.ptp):.4f}
te_largest_relative_at_one_position = [{", ".join(f"{worst[T]:.5f}" for T in TORQUES)}]

[summary]  # in the order of torques_Nm
te_mean_um = [{", ".join(f"{v.mean():.4f}" for v in te.values())}]
te_peak_to_peak_um = [{", ".join(f"{np.ptp(v):.4f}" for v in te.values())}]
''')
        print(folder, worst)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("command", choices=["compute", "write"])
    parser.add_argument("--h", type=float, default=0.01)
    parser.add_argument("--near", type=float, default=0.125)
    parser.add_argument("--cache", type=Path, required=True)
    parser.add_argument("--out", type=Path)
    o = parser.parse_args()
    compute(o.h, o.near, o.cache) if o.command == "compute" else write(o.cache, o.out)
