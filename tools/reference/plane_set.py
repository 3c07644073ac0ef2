"""Transmission error from sun to carrier of a planetary set at rest with one planet, all in plane strain: sun, planet and ring elastic, in contact; the planet's
bore glued to a rigid pin, sliding on it, or on rollers that press where they touch.

Sun z 27, planet z 24, ring z 75, m 2 mm, x 0, 20 deg; sun and planet addendum 1, rack tip radius 0.38; ring addendum 0.8, cut by 27 teeth (addendum 1.25, tip
radius 0.25), held over its outside of 170 mm; sun's bore 20 mm, held by its shaft; carrier and pin rigid. Planet's bore 20 mm (thick) and 37 mm (a rim of 1.5
modules). Rollers stand at equal angles, the first one towards the sun; each presses evenly over an arc of its own diameter, 10 mm long, after Palmgren
delta = (Q / (35948 l^(8/9)))^0.9 (N, mm), with a play. Sun pushes with its right flanks.

Of each contact on the path, and of each roller, the displacements under a unit load are read at all others (Hertz pressure of half width 0.1 mm, whose own half width
enters by its logarithm). What is left is a problem in forces >= 0 and the planet's motion in the plane. Quadratic triangles (scikit-fem); a second mesh with
all sizes doubled gives the error estimate.

    python plane_set.py ../../reference/plane_set
"""

import sys

import numpy as np
from plane_mesh import E_MPA, NU, PlaneBody, triangles, turned, write_table
from plane_planet import HALF_WIDTH, OUTSIDE, STRIP, body, outline
from plane_ring import Ring
from tooth import Tooth

DISTANCE, SUN_BORE, FACE = 51.0, 10.0, 10.0  # mm
# bore radius, rollers, their diameter and the play over the diameter
PLANETS = {"thin": (18.5, 14, 6.0, 0.010), "thick": (10.0, 12, 4.0, 0.010)}
POSITIONS = [0.08, 0.33, 0.58, 0.83]  # of a pitch of the sun
LOADS = [20.0, 100.0, 300.0]  # N/mm along the line of action
PALMGREN = 35948.0 * FACE ** (8 / 9)


def contacts(sun, planet, ring, share):
    """Of the sun's mesh and the ring's: (tooth, roll) on the first gear, (tooth, roll) on the second, radius; and the direction of the sun in the planet."""
    alpha = np.deg2rad(20.0)
    found = [], []
    towards = None
    for p in range(-4, 5):
        xi = np.tan(alpha) + (share - p) * sun.pitch_angle
        other = (DISTANCE * np.sin(alpha) - sun.r_base * xi) / planet.r_base
        if sun.xi_form <= xi <= sun.xi_tip and planet.xi_form <= other <= planet.xi_tip:
            radius = 1 / (1 / (sun.r_base * xi) + 1 / (planet.r_base * other))
            found[0].append(((p, xi), (-p, other), radius))
            here = -p * planet.pitch_angle - planet.half_base + other - alpha
            assert towards is None or abs(here - towards) < 1e-12
            towards = here
    for k in range(planet.z):
        # the ring lies opposite to the sun
        xi = k * planet.pitch_angle + planet.half_base + alpha - towards - np.pi
        xi = np.angle(np.exp(1j * xi))
        other = (planet.r_base * xi + DISTANCE * np.sin(alpha)) / ring.r_base
        if planet.xi_form <= xi <= planet.xi_tip and ring.xi_tip <= other <= ring.xi_form:
            radius = 1 / (1 / (planet.r_base * xi) - 1 / (ring.r_base * other))
            found[1].append(((k, xi), (k, other), radius))
    return *found, towards


def of_planet(t, places, towards, bore, rollers, size, fineness):
    """Compliance of the planet between its contacts (glued, sliding), and between contacts and rollers (floating); rows of its rigid motions
    (x, y, turn in mm at the base circle, counter-clockwise)."""
    at = []
    for tooth, xi, side in places:
        mirror = np.array([1.0, side])
        turn = t.pitch_angle * tooth
        at.append([turned(v[None] * mirror, turn)[0] for v in (t.flank(xi)[0], np.ravel(t.inward_normal(xi)))])
    pieces = []
    for k in range(t.z):
        own = {side: xi for tooth, xi, side in places if tooth % t.z == k}
        pieces += [turned(piece, t.pitch_angle * k) for piece in outline(t, own)]
    angles, half = towards + 2 * np.pi * np.arange(rollers) / rollers, size / 2 / bore
    edge = "0.7"
    for p, _ in at:
        edge = f"min({edge}, ({HALF_WIDTH / 8} + 0.1*sqrt((x-({p[0]}))^2+(y-({p[1]}))^2)))"
    mesh = triangles(pieces, bore, f"({edge})/{fineness}", [*(angles - half), *(angles + half)])
    held = [PlaneBody(mesh, bore, slides=slides) for slides in (False, True)]
    results = []
    for one in held:
        u = one.solve([one.hertz(p, n, HALF_WIDTH) for p, n in at])
        results.append(np.array([[n @ u[one.at(p), j] for j in range(len(at))] for p, n in at]))
    free = PlaneBody(mesh, bore, floats=True)
    pads = [free.pad(bore, a, half) for a in angles]
    u = free.solve([free.hertz(p, n, HALF_WIDTH) for p, n in at] + pads)
    rows = [n @ u[free.at(p), :] for p, n in at] + [pad @ u for pad in pads]
    results.append(np.array(rows))
    cross = lambda p, n: (p[0] * n[1] - p[1] * n[0]) / t.r_base
    rigid = [[n[0], n[1], cross(p, n)] for p, n in at]
    x, y = (np.zeros(free.basis.N) for _ in range(2))
    x[np.concatenate([free.basis.nodal_dofs[0], free.basis.facet_dofs[0]])] = 1.0
    y[np.concatenate([free.basis.nodal_dofs[1], free.basis.facet_dofs[1]])] = 1.0
    rigid += [[pad @ x, pad @ y, 0.0] for pad in pads]
    return results, np.array(rigid), len(free.free)


def solve(compliance, rigid, radius, drives, play, load):
    """Approach of the sun (mm) and forces (N/mm). `rigid`: displacement of each contact along its load by each rigid motion of the planet that it is free
    in; `drives`: contacts of the sun; the last ones are rollers with half a play (mm) each."""
    n, meshes, freedoms = len(rigid), len(radius), rigid.shape[1]
    modulus = E_MPA / (2 * (1 - NU**2))
    force, active = np.full(n, load / 4), np.ones(n, bool)
    play = np.concatenate([np.zeros(meshes), np.full(n - meshes, play)])
    known = np.column_stack([rigid, -drives])
    for _ in range(2000):
        a = np.flatnonzero(active)
        f, teeth = force[a], a[a < meshes]
        own = np.zeros((n, n))
        half = np.sqrt(4 * force[teeth] * radius[teeth] / (np.pi * modulus))
        own[teeth, teeth] = -2 * STRIP * np.log(half / HALF_WIDTH)
        rolls = a[a >= meshes]
        own[rolls, rolls] = (force[rolls] * FACE / PALMGREN) ** 0.9 / force[rolls]
        k = (compliance + own)[np.ix_(a, a)]
        g = known[a]
        system = np.block([[k, g], [g.T, np.zeros((freedoms + 1, freedoms + 1))]])
        right = np.concatenate([-play[a], np.zeros(freedoms), [-load]])
        found = np.linalg.solve(system, right)
        new = found[: len(a)]
        if new.min() <= 0:
            active[a[np.argmin(new)]] = False
            continue
        change = np.abs(new - f).max()
        force[:] = 0.0
        force[a] = new
        if change > 1e-12 * load:
            continue
        gaps = compliance @ force + known @ found[len(a) :] + play
        open_ = np.flatnonzero(~active)
        if len(open_) and gaps[open_].min() < -1e-12:
            worst = open_[np.argmin(gaps[open_])]
            active[worst], force[worst] = True, 1e-3 * load
            continue
        return found[-1], force
    raise RuntimeError("forces do not settle")


def readings(sun, planet, ring, share, fineness):
    of_sun_mesh, of_ring_mesh, towards = contacts(sun, planet, ring, share)
    c_sun, n_sun = body(sun, [(*first, -1) for first, _, _ in of_sun_mesh], SUN_BORE, fineness)
    c_ring, n_ring = body(ring, [(*second, -1) for _, second, _ in of_ring_mesh], OUTSIDE, fineness)
    places = [(*second, -1) for _, second, _ in of_sun_mesh] + [(*first, 1) for first, _, _ in of_ring_mesh]
    radius = np.array([r for *_, r in of_sun_mesh + of_ring_mesh])
    m = len(of_sun_mesh)
    drives = np.concatenate([np.ones(m), np.zeros(len(of_ring_mesh))])
    rows, most = {}, max(n_sun, n_ring)
    for name, (bore, rollers, size, play) in PLANETS.items():
        results, rigid, n = of_planet(planet, places, towards, bore, rollers, size, fineness)
        most = max(most, n)
        # rollers on a bore that does not bend: teeth as with the glued one
        stiff = np.zeros_like(results[2])
        stiff[: len(places), : len(places)] = results[0]
        for kind, compliance in zip(("glued", "sliding", "rollers", "rigid rollers"), [*results, stiff]):
            whole = compliance.copy()
            whole[:m, :m] += c_sun
            whole[m : m + len(c_ring), m : m + len(c_ring)] += c_ring
            count = len(whole)
            motions = rigid[:count] if "rollers" in kind else rigid[:count, 2:]
            driven = np.concatenate([drives, np.zeros(count - len(drives))])
            found = [solve(whole, motions, radius, driven, play / 2, load) for load in LOADS]
            rows[name, kind] = [approach for approach, _ in found] + [int((force[len(drives) :] > 0).sum()) for _, force in found[1:2]]
            if kind == "glued":
                # without what one mesh feels of the other
                own = whole.copy()
                own[:m, m:] = own[m:, :m] = 0.0
                rows[name, "own mesh"] = [solve(own, motions, radius, driven, 0.0, load)[0] for load in LOADS] + [0]
    return len(of_sun_mesh), len(of_ring_mesh), rows, most


def main(folder):
    sun, planet = (Tooth(z=z, m=2.0, x=0.0, rho=0.38) for z in (27, 24))
    ring = Ring(z=75, m=2.0, addendum=0.8, cutter=27)
    lines, worst, effects, dofs = [], 0.0, 0.0, 0
    for share in POSITIONS:
        *_, coarse, _ = readings(sun, planet, ring, share, 1.0)
        pairs, of_ring, fine, n = readings(sun, planet, ring, share, 2.0)
        dofs = max(dofs, n)
        for (name, kind), found in fine.items():
            worst = max(worst, np.abs(np.array(coarse[name, kind][:3]) / found[:3] - 1).max())
            if kind in ("sliding", "rollers"):
                without = {"sliding": "glued", "rollers": "rigid rollers"}[kind]
                adds = [np.array(rows[name, kind][:3]) - rows[name, without][:3] for rows in (coarse, fine)]
                effects = max(effects, np.abs(adds[0] / adds[1] - 1).max())
            lines.append((share, pairs, of_ring, name, kind, *found))
            print(*lines[-1], np.array(coarse[name, kind][:3]) / found[:3] - 1, n, flush=True)
    columns = "position_pitches,sun_pairs,ring_pairs,planet,bore," + ",".join(f"approach_um_at_{load:.0f}_N_per_mm" for load in LOADS) + ",rollers"
    table = [[*(str(v) for v in head), *(f"{v * 1e3:.6f}" for v in (a, b, c)), str(rollers)] for *head, a, b, c, rollers in lines]
    write_table(folder, columns, table, RECORD.format(dofs=dofs, worst=worst, effects=effects))


RECORD = '''title = "Transmission error from sun to carrier at rest, one planet, plane strain; bore glued, sliding, on rollers; thin and thick planet"
kind = "computed"
source = "tools/reference/plane_set.py: own tooth geometry and meshes (gmsh), finite elements by scikit-fem, own contact; not measured"

[set]
sun_teeth = 27
planet_teeth = 24
ring_teeth = -75
module_mm = 2.0
centre_distance_mm = 51.0
sun_bore_mm = 20.0
thin = "bore 37 mm, 14 rollers of 6 mm"
thick = "bore 20 mm, 12 rollers of 4 mm"
play_um = 10.0
roller_length_mm = 10.0

[columns]
position_pitches = "turn of the sun from where its right flank touches in the pitch point"
sun_pairs = "pairs of teeth on the path of contact, sun and planet"
ring_pairs = "the same, planet and ring"
bore = "glued, sliding, rollers; rigid rollers: rollers on a bore that stays round; own mesh: glued, without what one mesh feels of the other"
approach_um_at_100_N_per_mm = "approach of the sun's base circle, ring and carrier held; load along the line of action, all pairs together"
rollers = "rollers that carry at the middle load"

[method]
state = "plane strain, whole bodies; sun held at its bore, ring outside"
elements = "quadratic triangles with straight edges, at most {dofs} degrees of freedom"
error_estimate = "all element sizes doubled change the approach by at most {worst:.1e}, what sliding and rollers add by at most {effects:.1e} of itself"
'''

if __name__ == "__main__":
    main(sys.argv[1])
