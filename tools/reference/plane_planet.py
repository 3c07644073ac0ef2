"""Transmission error of a planet in a ring at rest, both in plane strain: whole bodies on meshes graded to the contacts, rigid path of contact.

Planet z 24, ring z 75, m 2 mm, x 0, 20 deg; planet addendum 1, rack tip radius 0.38, bore 20 mm fixed; ring addendum 0.8, cut by 27 teeth (addendum
1.25, tip radius 0.25), held over its outside of 170 mm; E 206 GPa, nu 0.3. The planet drives. Of each contact on the path the displacements under a Hertz
pressure of half width 0.1 mm are read at all contacts' centres; the pressure's own half width enters by its logarithm. What is left is a linear problem with
F >= 0. Quadratic triangles (scikit-fem); a second mesh with all sizes doubled gives the error estimate.

    python plane_planet.py ../../reference/plane_planet
"""

import sys

import numpy as np
from plane_gear import tooth_pieces
from plane_mesh import E_MPA, FLIP, NU, PlaneBody, triangles, turned, write_table
from plane_ring import Ring, pieces_of
from tooth import Tooth

BORE, OUTSIDE = 10.0, 85.0  # mm, radii
DISTANCE = 51.0  # mm
HALF_WIDTH = 0.1  # mm
POSITIONS = [0.04, 0.21, 0.38, 0.55, 0.72, 0.89]  # of a pitch
LOADS = [20.0, 100.0, 300.0]  # N/mm along the line of action, all pairs together
STRIP = 2 * (1 - NU**2) / (np.pi * E_MPA)


def body(t, places, circle, fineness, largest=2.0, slides=(False,)):
    """places: (tooth, roll angle, side) of each contact, side 1 at positive polar angle; compliance between them, mm per N/mm, the circle held, or sliding."""
    contacts = []
    for tooth, xi, side in places:
        mirror = np.array([1.0, side])
        point, normal = t.flank(xi)[0] * mirror, np.ravel(t.inward_normal(xi)) * mirror
        contacts.append((turned(point[None], t.pitch_angle * tooth)[0], turned(normal[None], t.pitch_angle * tooth)[0]))
    pieces = []
    for k in range(t.z):
        # a node on the flank at each contact
        own = {side: xi for tooth, xi, side in places if tooth % t.z == k}
        for piece in outline(t, own):
            pieces.append(turned(piece, t.pitch_angle * k))
    middle = np.mean([p for p, _ in contacts], axis=0)
    size = f"(0.25 + 0.12*max(sqrt((x-({middle[0]}))^2+(y-({middle[1]}))^2)-10.0, 0))"
    for p, _ in contacts:
        size = f"min({size}, ({HALF_WIDTH / 8} + 0.1*sqrt((x-({p[0]}))^2+(y-({p[1]}))^2)))"
    mesh, found = triangles(pieces, circle, f"min({size}, {largest})/{fineness}"), []
    for slide in slides:
        held = PlaneBody(mesh, circle, slides=slide)
        u = held.solve([held.hertz(p, n, HALF_WIDTH) for p, n in contacts])
        found.append(np.array([[n @ u[held.at(p), j] for j in range(len(contacts))] for p, n in contacts]))
    return *found, len(held.free)


def outline(t, own):
    """Pieces of a pitch; its contact's side must be the one at negative polar angle, or that of the mirror image."""
    if not own:
        return tooth_pieces(t, None) if isinstance(t, Tooth) else pieces_of(t, [])
    (side, xi), = own.items()
    pieces = tooth_pieces(t, xi) if isinstance(t, Tooth) else pieces_of(t, [xi])
    return pieces if side < 0 else [p[::-1] * FLIP for p in pieces[::-1]]


def solve(compliance, radius, load):
    """Approach (mm) and forces (N/mm) of contacts that share a load."""
    n = len(radius)
    modulus = E_MPA / (2 * (1 - NU**2))
    active, force = np.ones(n, bool), np.full(n, load / n)
    for _ in range(100):
        a = np.flatnonzero(active)
        half = np.sqrt(4 * force[a] * radius[a] / (np.pi * modulus))
        own = compliance[np.ix_(a, a)] - np.diag(2 * STRIP * np.log(half / HALF_WIDTH))
        system = np.block([[own, -np.ones((len(a), 1))], [np.ones((1, len(a))), np.zeros((1, 1))]])
        found = np.linalg.solve(system, np.append(np.zeros(len(a)), load))
        if found[:-1].min() <= 0:
            active[a[np.argmin(found[:-1])]] = False
            continue
        change = np.abs(found[:-1] - force[a]).max()
        force = np.zeros(n)
        force[a] = found[:-1]
        if change < 1e-12 * load:
            gaps = compliance @ force - found[-1]
            assert (gaps[~active] >= 0).all()
            return found[-1], force
    raise RuntimeError("forces do not settle")


def readings(planet, ring, share, fineness):
    alpha = np.arccos((ring.r_base - planet.r_base) / DISTANCE)
    line = DISTANCE * np.sin(alpha)
    pairs = []
    for p in range(-3, 4):
        xi = np.tan(alpha) + (share - p) * planet.pitch_angle
        other = (planet.r_base * xi + line) / ring.r_base
        if xi <= planet.xi_tip and other >= ring.xi_tip:
            pairs.append((p, xi, other))
    # the planet's right flanks touch left ones of the ring
    of_planet, n = body(planet, [(p, xi, -1) for p, xi, _ in pairs], BORE, fineness)
    of_ring, m = body(ring, [(p, xi, 1) for p, _, xi in pairs], OUTSIDE, fineness)
    radius = np.array([1 / (1 / (planet.r_base * xi) - 1 / (ring.r_base * other)) for _, xi, other in pairs])
    found = [solve(of_planet + of_ring, radius, load) for load in LOADS]
    return len(pairs), np.array([approach for approach, _ in found]), max(n, m)


def main(folder):
    planet = Tooth(z=24, m=2.0, x=0.0, rho=0.38)
    ring = Ring(z=75, m=2.0, addendum=0.8, cutter=27)
    rows, worst, dofs = [], 0.0, 0
    for share in POSITIONS:
        _, coarse, _ = readings(planet, ring, share, 1.25)
        pairs, fine, n = readings(planet, ring, share, 2.5)
        worst, dofs = max(worst, np.abs(coarse / fine - 1).max()), max(dofs, n)
        print(share, pairs, fine * 1e3, coarse / fine - 1, n, flush=True)
        rows.append((share, pairs, *fine))
    columns = "position_pitches,pairs," + ",".join(f"approach_um_at_{load:.0f}_N_per_mm" for load in LOADS)
    table = [[str(share), str(pairs), *(f"{a * 1e3:.6f}" for a in approach)] for share, pairs, *approach in rows]
    write_table(folder, columns, table, RECORD.format(dofs=dofs, worst=worst))


RECORD = '''title = "Transmission error of a planet in a ring at rest, plane strain, six positions, three loads"
kind = "computed"
source = "tools/reference/plane_planet.py: own tooth geometry and meshes (gmsh), finite elements by scikit-fem, own contact; not measured"

[planet]
teeth = 24
module_mm = 2.0
bore_diameter_mm = 20.0
rack_tip_radius = 0.38

[ring]
teeth = -75
addendum = 0.8
cutter_teeth = 27
outer_diameter_mm = 170.0

[pair]
centre_distance_mm = 51.0
young_GPa = 206.0
poisson = 0.3

[columns]
position_pitches = "driver angle from the pitch point, planet drives on its right flanks"
pairs = "pairs of teeth on the path of contact"
approach_um_at_100_N_per_mm = "approach of the base circles, minus the transmission error; load along the line of action, all pairs together"

[method]
state = "plane strain, whole planet held at its bore, whole ring held outside"
elements = "quadratic triangles with straight edges, at most {dofs} degrees of freedom"
error_estimate = "all element sizes doubled change the approach by at most {worst:.1e}"
'''

if __name__ == "__main__":
    main(sys.argv[1])
