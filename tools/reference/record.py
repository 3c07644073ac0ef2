"""Writes record.toml and data.csv of the computed pairs, with error estimates from the mesh sequence."""

import pickle
import time

import numpy as np

from make_reference import GAUGES, MESHES, N_PITCH, N_REPEAT, TORQUES, Z, suffix

SIDES = ("tension", "compression")
TITLE = {"a": "Gear pair A: solid gear 1 drives thin-rim gear 2 (57/57, m 2.6 mm)",
         "b": "Gear pair B: solid gear 1 drives thin-rim gear 3 with three web slots (57/57, m 2.6 mm)"}
DRIVEN = {"a": "gear2", "b": "gear3"}
METHOD = """\
Quasi-static, {friction}, contact on the theoretical line of action only (path = line-of-action), no misalignment, no
thickness allowance, no chamfer. Compliance: 27-node hexahedra, half width with a plane of symmetry at mid-face, one tooth
pitch condensed on its cut faces; {body}.
Full tooth-to-tooth coupling. Line loads, uniform over each of {slices} slices of the half width. Near field: each slice's own term is corrected by c0 - w_h - 2(1-nu^2)/(pi E) ln(a/a0) for both gears, from plane
strain: c0 under a Hertz pressure of half width a0 = 0.05 mm on a graded triangle mesh (cut off at the tip edge, resultant
kept), w_h under the line load on the section of the 3D mesh. Contact: active set with Newton steps, torque given.
Strain: mean of the tangential surface strain over the gauge patch under the same line loads; teeth whose loads are not next
to the gauge count too, through the rim and the web."""
BODY = {"a": "57 equal pitches joined by cyclic symmetry for both gears",
        "b": "gear 1 by cyclic symmetry of 57 equal pitches, gear 3: hub and slotted web as one mesh of the whole circle, condensed where it meets the rim (web_elements_mm: its element size)"}


def changes(results, summary):
    """Figures of the finest mesh, and {mesh: {figure: {torque: finest - mesh}}} for the others."""
    s = {m: summary(r) for m, r in results.items()}
    best, *others = [m for m in MESHES if m in results]
    return s[best], {m: {n: {T: s[best][T][n] - s[m][T][n] for T in TORQUES} for n in s[best][TORQUES[0]]} for m in others}


def write_records(cache, out, summary, mu):
    for p in "ab":
        load = lambda tail: pickle.loads(f.read_bytes()) if (f := cache / f"pair_{p}{suffix(mu)}_{tail}.pkl").exists() else None
        res = {m: r for m in MESHES if (r := load(m))}
        if len(res) > 1:
            write_one(p, res, out / f"pair_{p}{'_friction' if mu else ''}", summary, mu, load(f"{next(iter(res))}_bends"))


FRICTION = """\
Coulomb friction {mu:g} along the profile, towards both roots before the pitch point and towards both tips after it, none in
it; it turns the driven gear with the lever arm rho_2 and strains its root, and does not bend teeth towards their mates"""


def write_one(p, res, folder, summary, mu, bends):
    folder.mkdir(parents=True, exist_ok=True)
    best = next(m for m in MESHES if m in res)
    r = res[best]
    cols, heads = [np.arange(Z * N_PITCH) * 360.0 / (Z * N_PITCH)], ["angle_deg"]
    for T in TORQUES:
        heads.append(f"te_um_{T}Nm")
        cols.append(r["te"][T])
    for k in GAUGES[p]:
        for c, side in enumerate(SIDES):
            for T in TORQUES:
                heads.append(f"strain_t{k}_{side}_ustrain_{T}Nm")
                cols.append(r["strain"][T, k][:, c])
    data = np.column_stack(cols)
    assert np.isfinite(data).all()
    with open(folder / "data.csv", "w", newline="\n") as f:
        f.write(",".join(heads) + "\n")
        for row in data:
            f.write(f"{row[0]:.6f}," + ",".join(f"{v:.6g}" for v in row[1:]) + "\n")

    fine, ch = changes(res, summary)
    closest = next(iter(ch))
    big = lambda m, n: max(abs(v) for v in ch[m][n].values())
    top = lambda n: max(abs(fine[T][n]) for T in TORQUES)
    strain_names = [n for n in fine[TORQUES[0]] if n.endswith("_range")]
    rel = lambda m, n: max(abs(ch[m][n][T] / fine[T][n]) for T in TORQUES)
    L = []
    q = lambda s: '"' + s.replace("\\", "\\\\").replace('"', '\\"') + '"'
    slices = len(MESHES[best]["z"]) - 1
    L += [f"title = {q(TITLE[p] + (f', friction {mu:g}' if mu else ''))}", 'kind = "computed"',
          'source = "computed with tools/reference (Python, own finite elements and contact solver), no code shared with gearmesh; nothing in it is measured"',
          'method = """\n' + METHOD.format(body=BODY[p], slices=slices, friction=FRICTION.format(mu=mu) if mu else 'frictionless') + '"""',
          f'command = "python tools/reference/make_reference.py{f" --mu {mu:g}" if mu else ""} (see tools/reference/README.md)"',
          f"date = {time.strftime('%Y-%m-%d')}",
          'angle_origin = "driver angle 0: the unmodified right flanks of tooth 0 of gear 1 and of tooth 0 of the driven gear touch at the pitch point"',
          f"torques_Nm = [{', '.join(map(str, TORQUES))}]",
          f"points_per_revolution = {Z * N_PITCH}", f"points_per_pitch = {N_PITCH}",
          (f'periodicity = "computed over one tooth pitch; TE repeated {Z} times; strain assembled for the whole revolution from those contact forces"' if p == "a" else
           f'periodicity = "computed over {N_REPEAT} tooth pitches (120 degrees); TE repeated {Z // N_REPEAT} times; strain assembled for the whole revolution from those contact forces"'),
          "", "[conventions]",
          'te = "TE = r_b2 theta2 - r_b1 theta1, each angle positive in its gear\'s own sense of turning; 0 where unmodified flanks touch without load; negative under load"',
          'torque = "torque on the driven gear, full width"',
          'strain = "tangential to the tooth profile in the transverse plane, tension positive; zero without load"',
          'teeth = "numbered counter-clockwise seen from +z, tooth 0 centred on +x; pair p is gear 1 tooth p with driven tooth -p (mod 57); right flanks in contact; gear 1 turns clockwise"',
          'units = "angle in degrees, TE in micrometres, strain in microstrain, torque in newton metres"',
          "", "[gears]", 'driver = "gear1"', f'driven = "{DRIVEN[p]}"', "centre_distance_mm = 150.0",
          'profile_crowning = "gear 1: e(xi) = 10 um ((xi - xi_150) / (xi_tip - xi_150))^2 of roll angle xi, material removed, on both sides of d = 150 mm; driven gear unmodified"',
          "", "[material]", "youngs_modulus_GPa = 210.0", "poisson_ratio = 0.3", ""]
    for k in GAUGES[p]:
        for side, word in zip(SIDES, ("right", "left")):
            L += ["[[gauges]]", f'name = "t{k}_{side}"', f'gear = "{DRIVEN[p]}"', f"tooth = {k}", f'side = "{word}"',
                  'position = "30 degree tangent point of the fillet"', "length_mm = 0.8", "z_centre_mm = 0.0", "width_mm = 3.0", ""]
    L += ["[mesh]", f'record = "{best}"', 'element = "27-node hexahedron; section with 9-node quadrilaterals"']
    for m in res:
        d = MESHES[m]
        L.append(f"{m} = {{ flank_elements = {d['n_flank']}, fillet_elements = {d['n_fillet']}, half_tooth_elements = {d['n_half']}, "
                 f"rim_elements = {d['n_depth']}, " + (f"web_elements_mm = {d['h_web']}, " if p == "b" else "") + f"z_planes_half_width_mm = [{', '.join(f'{z:g}' for z in d['z'])}] }}")
    L += ["", "[uncertainty]",
          f"# largest change over the six torques between the mesh of the record and the {closest} mesh, plus an allowance for what the two",
          "# meshes share: 0.1 percent of the TE (layers at the web face) and 0.2 percent of the strain (section and layers).",
          "# It covers the numerical solution of the stated model only, not what the model leaves out.",
          f"te_mean_um = {big(closest, 'te_mean') + 1e-3 * top('te_mean'):.4f}",
          f"te_peak_to_peak_um = {big(closest, 'te_pp') + 1e-3 * top('te_pp'):.4f}",
          f"strain_range_ustrain = {max(big(closest, n) + 2e-3 * top(n) for n in strain_names):.2f}",
          f"te_mean_relative = {rel(closest, 'te_mean') + 1e-3:.5f}", f"te_peak_to_peak_relative = {rel(closest, 'te_pp') + 1e-3:.5f}",
          f"strain_range_relative = {max(rel(closest, n) for n in strain_names) + 2e-3:.5f}",
          'how = "mesh changes below; layers refined at the web face change the compliance of gear 2 by 0.07 percent and its gauge strain by 0.1 percent; the section of the record mesh gives the gauge strain of a plane-strain section with 24 flank and 20 fillet elements within 0.1 percent"',
          ""]
    for m in ch:
        L.append(f"[mesh_change.{m}_to_record]")
        for n in ch[m]:
            unit = "um" if n.startswith("te") else "ustrain"
            L.append(f"{n}_{unit} = [{', '.join(f'{ch[m][n][T]:.4f}' for T in TORQUES)}]")
        L.append("")
    if bends:
        all_in = summary(bends)
        L.append("[left_out.bending_by_friction]  # what changes where friction bends teeth towards their mates, too")
        for n in fine[TORQUES[0]]:
            unit = "um" if n.startswith("te") else "ustrain"
            L.append(f"{n}_{unit} = [{', '.join(f'{all_in[T][n] - fine[T][n]:.4f}' for T in TORQUES)}]")
        L.append("")
    L.append("[summary]  # in the order of torques_Nm")
    for n in fine[TORQUES[0]]:
        unit = "um" if n.startswith("te") else "ustrain"
        L.append(f"{n}_{unit} = [{', '.join(f'{fine[T][n]:.4f}' for T in TORQUES)}]")
    (folder / "record.toml").write_text("\n".join(L) + "\n")
    import tomllib
    tomllib.loads((folder / "record.toml").read_text())
    print(folder, (folder / "data.csv").stat().st_size // 1000, "kB")
