"""Deflection of a ring that is held by six lugs, whole ring in plane strain: teeth over a lug and half way between two.

The thin ring of plane_ring.py (z 60, m 3 mm, rim of 1.5 modules), its outside fixed over 10 deg at every 60 deg, the first around the middle of tooth 0; 100 N/mm
at the radius 90 mm on the right flank of tooth 0 or tooth 5, read there and on the teeth beside it. Quadratic triangles (scikit-fem), graded to the load, to the
fillets and to the edges of the lugs; a second mesh with all sizes doubled gives the error estimate.

    python plane_lugs.py ../../reference/plane_lugs
"""

import sys

import numpy as np
from plane_gear import LOAD
from plane_mesh import FLIP, PlaneBody, triangles, turned, write_table
from plane_ring import HALF_WIDTH, OUTSIDE, Ring, pieces_of

RADIUS, LUGS, WIDTH = 90.0, 6, np.deg2rad(10.0)
TEETH = [0, 5]


def readings(t, tooth, fineness):
    """Deflection (mm) of the loaded tooth, the one after and the one before; degrees of freedom."""
    outside = OUTSIDE["thin"]
    edges = [2 * np.pi / LUGS * k + half * WIDTH for k in range(LUGS) for half in (-0.5, 0.5)]
    pieces = [turned(p, t.pitch_angle * k) for k in range(t.z) for p in pieces_of(t, [t.xi(RADIUS)])]
    at = lambda k: turned((t.flank(t.xi(RADIUS))[0] * FLIP)[None], t.pitch_angle * k)[0]
    normal = lambda k: turned((t.inward_normal(t.xi(RADIUS)) * FLIP)[None], t.pitch_angle * k)[0]
    p = at(tooth)
    size = f"min(0.4 + 0.05*sqrt((x-({p[0]}))^2+(y-({p[1]}))^2), {HALF_WIDTH / 8} + 0.1*sqrt((x-({p[0]}))^2+(y-({p[1]}))^2))"
    for a in edges:
        x, y = outside * np.cos(a), outside * np.sin(a)
        size = f"min({size}, 0.003 + 0.15*sqrt((x-({x}))^2+(y-({y}))^2))"
    size = f"min({size}, 0.25 + 0.2*abs(sqrt(x^2+y^2)-{t.r_root - 0.3}))"  # edges are straight: fillets
    holds = lambda angle: np.abs((angle + np.pi / LUGS) % (2 * np.pi / LUGS) - np.pi / LUGS) < 0.5 * WIDTH
    body = PlaneBody(triangles(pieces, outside, f"min({size}, 1.0)/{fineness}", edges), outside, holds)
    u = body.solve([LOAD * body.hertz(p, normal(tooth), HALF_WIDTH)])[:, 0]
    return np.array([normal(k) @ u[body.at(at(k))] for k in (tooth, tooth + 1, tooth - 1)]), len(body.free)


def main(folder):
    t = Ring()
    rows, worst, dofs = [], 0.0, 0
    for tooth in TEETH:
        coarse, _ = readings(t, tooth, 1.0)
        fine, n = readings(t, tooth, 2.0)
        change = np.abs(coarse - fine).max() / fine[0]
        worst, dofs = max(worst, change), max(dofs, n)
        print(tooth, fine * 1e3, change, n, flush=True)
        rows.append((tooth, *fine))
    columns = "tooth,own_um,tooth_after_um,tooth_before_um"
    table = [[str(tooth), *(f"{v * 1e3:.6f}" for v in found)] for tooth, *found in rows]
    write_table(folder, columns, table, RECORD.format(dofs=dofs, worst=worst))


RECORD = '''title = "Flank deflection of a ring gear held by six lugs, plane strain"
kind = "computed"
source = "tools/reference/plane_lugs.py: own tooth geometry and mesh (gmsh), finite elements by scikit-fem; not measured"

[gear]
like = "plane_ring, outer diameter 196.5 mm"
lugs = "6, 10 deg wide, the first around the middle of tooth 0"

[columns]
tooth = "loaded tooth, 100 N/mm on its right flank at the radius 90 mm, Hertz pressure of half width 0.06 mm"
own_um = "displacement of the load's centre along the inward normal"
tooth_after_um = "that of the same place on the next tooth, counter-clockwise"
tooth_before_um = "and on the one before"

[method]
state = "plane strain, whole ring"
elements = "quadratic triangles with straight edges, at most {dofs} degrees of freedom"
error_estimate = "all element sizes doubled change deflections by at most {worst:.1e} of the largest"
'''

if __name__ == "__main__":
    main(sys.argv[1])
