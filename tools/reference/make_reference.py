"""Computes the reference records of gear pairs A and B. See README.md.

    python make_reference.py compute --mesh fine   --cache DIR
    python make_reference.py compute --mesh coarse --cache DIR
    python make_reference.py write   --cache DIR --out ../../reference

With `--mu 0.3` the same with friction: reference/pair_a_friction and pair_b_friction.
"""

import argparse
import pickle
import resource
import time
from pathlib import Path

import numpy as np

import near_field as nf
from contact import Pair
from gears import Pitch, cyclic_gear, log
from slotted import slotted_gear
from tooth import Tooth

Z, N_PITCH, N_REPEAT = 57, 48, 19
TORQUES = (50, 100, 150, 200, 250, 300)
R_RIM, WEB_HALF = 68.35, 2.5
MESHES = {
    "fine": dict(n_flank=12, n_fillet=5, n_half=5, n_depth=4, n_space=4, grade_half=0.2, grade_depth=3.0, n_web=10, n_hub=4,
                 h_web=2.2, n_hub_arc=18, z=(0, 1.25, 2.5, 4, 5.75, 7.5, 9.25, 10.5, 11.5)),
    "medium": dict(n_flank=12, n_fillet=5, n_half=4, n_depth=4, n_space=4, n_web=10, n_hub=4, h_web=2.6, n_hub_arc=16,
                   z=(0, 1.25, 2.5, 4.5, 6.5, 8.5, 10.25, 11.5)),
    "coarse": dict(n_flank=8, n_fillet=4, n_half=3, n_depth=3, n_space=3, n_web=6, n_hub=2, h_web=3.0, n_hub_arc=14,
                   z=(0, 2.5, 5.5, 8.5, 11.5)),
}
# driven teeth with gauges, per pair
GAUGES = {"a": (0,), "b": (0, 9)}


def cached(path, make):
    if path.exists():
        return pickle.loads(path.read_bytes())
    t0 = time.time()
    v = make()
    path.with_suffix(".tmp").write_bytes(pickle.dumps(v, protocol=5))
    path.with_suffix(".tmp").rename(path)
    log(f"{path.name}: {time.time() - t0:.0f} s")
    return v


def gear(name, tooth, mesh_name, cache):
    """Gear compliance of 'gear1' (solid), 'gear2' (thin rim), 'gear3' (thin rim, 3 slots)."""
    mesh = MESHES[mesh_name]
    z = mesh["z"]
    lookup = {}

    def make():
        if name == "gear3" or name == "gear2_full":
            p = Pitch(tooth, z, mesh, web_half=WEB_HALF, ring_only=True)
            g = slotted_gear(p, Z, z, N_REPEAT if name == "gear3" else 1, slots=name == "gear3",
                             h_web=mesh["h_web"], n_hub=mesh["n_hub_arc"])
        else:
            p = Pitch(tooth, z, mesh, web_half=None if name == "gear1" else WEB_HALF)
            g = cyclic_gear(p, Z, z)
        return g

    return cached(cache / f"{name}_{mesh_name}.pkl", make)


def near_field(tooth, mesh_name, cache):
    xi_min = 150 * np.sin(np.arccos(2 * tooth.r_base / 150)) / tooth.r_base - tooth.xi_tip
    st = nf.stations(tooth, xi_min - 1e-9)
    c = cached(cache / "c0.pkl", lambda: [nf.c0(tooth, R_RIM, x)[0] for x in st])
    return nf.NearField(tooth, R_RIM, MESHES[mesh_name], st, c)


def run_pair(pair_name, mesh_name, cache, torques=TORQUES, n_pitch=N_PITCH, mu=0.0, bends=False):
    """TE (µm) and gauge strains (microstrain) over one driver revolution."""
    tooth = Tooth()
    near = near_field(tooth, mesh_name, cache)
    pair = Pair(gear("gear1", tooth, mesh_name, cache), gear("gear2" if pair_name == "a" else "gear3", tooth, mesh_name, cache),
                near, near, mu=mu, bends=bends)
    pitches = 1 if pair_name == "a" else N_REPEAT
    driven = pair.g[1]
    te = {T: np.empty(Z * n_pitch) for T in torques}
    strain = {(T, k): np.zeros((Z * n_pitch, 2)) for T in torques for k in GAUGES[pair_name]}
    forces = []
    for i in range(pitches * n_pitch):
        theta = i * tooth.pitch_angle / n_pitch
        system = pair.system(theta)
        pats = [driven.pattern(xi2) + pair.friction(xi1) * driven.pattern(xi2, along=True) for _, xi1, xi2 in system[0]]
        for T in torques:
            e, F = pair.solve(system, T, nf.A0)
            for rep in range(Z // pitches):
                row = i + rep * pitches * n_pitch
                te[T][row] = e * 1e3
                for k in GAUGES[pair_name]:
                    for q, (p, _, _) in enumerate(system[0]):
                        j = (-(p + rep * pitches)) % Z
                        rows = driven.block(k, j)[-2:, : driven.n_load]
                        strain[T, k][row] += rows @ (pats[q].T @ F[q * driven.n_slices : (q + 1) * driven.n_slices]) * 1e6
            if i < n_pitch:
                forces.append((i, T, [p for p, *_ in system[0]], F))
    return dict(te=te, strain=strain, forces=forces, n_pitch=n_pitch)


def summary(r):
    out = {}
    for T, te in r["te"].items():
        out[T] = dict(te_mean=te.mean(), te_pp=np.ptp(te))
        for (t, k), s in r["strain"].items():
            if t == T:
                for c, side in enumerate(("tension", "compression")):
                    out[T][f"t{k}_{side}_range"] = np.ptp(s[:, c])
    return out


def suffix(mu):
    """Of the names of files with friction."""
    return f"_mu{mu:g}" if mu else ""


def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("what", choices=("compute", "write"))
    ap.add_argument("--mesh", choices=MESHES, default="fine")
    ap.add_argument("--pairs", default="ab")
    ap.add_argument("--cache", type=Path, required=True)
    ap.add_argument("--out", type=Path)
    ap.add_argument("--mu", type=float, default=0.0)
    ap.add_argument("--bends", action="store_true", help="count the friction's own part of the deflection (printed only)")
    a = ap.parse_args()
    a.cache.mkdir(parents=True, exist_ok=True)
    if a.what == "compute":
        for p in a.pairs:
            t0 = time.time()
            r = cached(a.cache / f"pair_{p}{suffix(a.mu)}_{a.mesh}{'_bends' if a.bends else ''}.pkl",
                       lambda: run_pair(p, a.mesh, a.cache, mu=a.mu, bends=a.bends))
            s = summary(r)
            for T in TORQUES:
                log(f"pair {p} {a.mesh} {T} Nm " + "  ".join(f"{k} {v:.4f}" for k, v in s[T].items()))
            mem = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
            log(f"pair {p}: {time.time() - t0:.0f} s, peak memory {mem:.1f} GiB")
    else:
        from record import write_records
        write_records(a.cache, a.out, summary, a.mu)


if __name__ == "__main__":
    main()
