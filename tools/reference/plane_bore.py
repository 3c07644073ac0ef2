"""Deflection of a planet that sun and ring press from opposite sides, its bore glued to a rigid pin or sliding on it, plane strain.

The planet of plane_planet.py (z 24, m 2 mm), bore 20 mm (thick) and 37 mm (a rim of 1.5 modules); 1 N/mm on the right flank of tooth 0 and on the left flank of
tooth 12, so that the moments cancel, at two radii, the same on both. Read is the sum of both deflections at the loads' centres under both loads: that of the
transmission error from sun to ring. Half width of the Hertz pressures 0.1 mm. Quadratic triangles (scikit-fem); a second mesh with all sizes doubled gives the
error estimate.

    python plane_bore.py ../../reference/plane_bore
"""

import sys

import numpy as np
from plane_mesh import write_table
from plane_planet import body
from tooth import Tooth

BORES = {"thin": 18.5, "thick": 10.0}  # mm, radii
RADII = [23.0, 25.3]  # mm


def deflections(t, bore, radius, fineness):
    """Both sums (mm per N/mm), bore glued and sliding; degrees of freedom."""
    xi = t.xi(radius)
    glued, sliding, n = body(t, [(0, xi, -1), (12, xi, 1)], bore, fineness, 0.5, (False, True))
    return np.array([glued.sum(), sliding.sum()]), n


def main(folder):
    t = Tooth(z=24, m=2.0, x=0.0, rho=0.38)
    rows, worst, dofs = [], np.zeros(2), 0
    for bore in BORES.values():
        for radius in RADII:
            coarse, _ = deflections(t, bore, radius, 1.25)
            fine, n = deflections(t, bore, radius, 2.5)
            effect = lambda found: found[1] - found[0]
            change = [abs(coarse[0] / fine[0] - 1), abs(effect(coarse) / effect(fine) - 1)]
            worst, dofs = np.maximum(worst, change), max(dofs, n)
            print(bore, radius, fine * 1e3, effect(fine) / fine[0], change, n, flush=True)
            rows.append((2 * bore, radius, *fine))
    columns = "bore_mm,radius_mm,glued_nm_per_N_per_mm,sliding_nm_per_N_per_mm"
    table = [[f"{bore:.1f}", f"{radius:.1f}", *(f"{v * 1e6:.6f}" for v in found)] for bore, radius, *found in rows]
    write_table(folder, columns, table, RECORD.format(dofs=dofs, glued=worst[0], effect=worst[1]))


RECORD = '''title = "Deflection of a planet pressed from opposite sides, bore glued and sliding, plane strain, two bores, two radii"
kind = "computed"
source = "tools/reference/plane_bore.py: own tooth geometry and meshes (gmsh), finite elements by scikit-fem; not measured"

[gear]
like = "planet of plane_planet, bores of 37 and 20 mm"

[columns]
bore_mm = "diameter of the bore"
radius_mm = "radius of both loads: right flank of tooth 0, left flank of tooth 12, 1 N/mm, half width of the Hertz pressures 0.1 mm"
glued_nm_per_N_per_mm = "sum of both deflections along the inward normals, bore fixed"
sliding_nm_per_N_per_mm = "the same, bore free to slide along a rigid pin"

[method]
state = "plane strain, whole planet"
elements = "quadratic triangles with straight edges, at most {dofs} degrees of freedom"
error_estimate = "all element sizes doubled change the glued sums by at most {glued:.1e}, what sliding adds by at most {effect:.1e} of itself"
'''

if __name__ == "__main__":
    main(sys.argv[1])
