"""Deflection of a gear's flank under a Hertz pressure, whole gear in plane strain, on a mesh graded to the load.

z 50, m 3 mm, x 0, 20 deg, addendum 1, dedendum 1.25, rack tip radius 0.38; bore radius 30 mm fixed; E 206 GPa, nu 0.3; 100 N/mm on
the right flank of one tooth. Straight triangles with quadratic displacement (scikit-fem), graded to a twentieth of the smaller
half width; a second mesh with all sizes doubled gives the error estimate. Five minutes on one core.

    python plane_gear.py ../../reference/plane_gear
"""

import sys

import numpy as np
from plane_mesh import FLIP, PlaneBody, arc, triangles, turned, write_table
from tooth import Tooth

LOAD = 100.0  # N/mm
BORE = 30.0  # mm
RADII = [72.6, 73.5, 74.25, 75.0, 76.0, 77.0, 77.7]
HALF_WIDTHS = [0.06, 0.12]


def tooth_pieces(t, split):
    """Outline of one tooth pitch, counter-clockwise: root arc and fillet, flank (split at the load), tip, and back."""
    hp = t.pitch_angle / 2
    fillet = t.fillet_dense(801)[0][::8]  # from the involute to the root
    at_root, at_tip = (np.arctan2(p[1], p[0]) for p in (fillet[-1], t.flank(t.xi_tip)[0]))
    cuts = [t.xi_form] + ([split] if split else []) + [t.xi_tip]
    right = [t.flank(np.linspace(a, b, 40)) * FLIP for a, b in zip(cuts, cuts[1:])]
    return ([arc(t.r_root, -hp, -at_root, 4), fillet[::-1] * FLIP] + right
            + [arc(t.r_tip, -at_tip, at_tip, 8), t.flank(np.linspace(t.xi_tip, t.xi_form, 40)), fillet, arc(t.r_root, at_root, hp, 4)])


def mesh(t, xi, fineness):
    """Triangles of the whole gear; all element sizes are divided by `fineness`."""
    pieces = [turned(p, t.pitch_angle * k) for k in range(t.z) for p in tooth_pieces(t, xi if k == 0 else None)]
    p = t.flank(xi)[0] * FLIP
    d = f"sqrt((x-({p[0]}))^2+(y-({p[1]}))^2)"
    axis = f"sqrt((x-{t.r})^2+y^2)"  # distance from the middle of the loaded tooth
    h0 = HALF_WIDTHS[0] / 8  # all of these are divided by `fineness`, 2.5 in the record
    # a tenth of the distance from the load, at most 0.25 mm on the loaded tooth, growing to 2.5 mm in the body
    near = f"({h0} + 0.1*{d})"
    far = f"(0.25 + 0.12*max({axis}-6.0, 0))"
    return triangles(pieces, BORE, f"min(min({near}, {far}), 2.5)/{fineness}")


def deflections(t, radius, fineness):
    """mm, displacement of the contact centre along the inward normal, one value a half width; and degrees of freedom."""
    xi = t.xi(radius)
    centre, normal = t.flank(xi)[0] * FLIP, t.inward_normal(xi)[0] * FLIP
    body = PlaneBody(mesh(t, xi, fineness), BORE)
    u = body.solve([LOAD * body.hertz(centre, normal, a) for a in HALF_WIDTHS])
    return normal @ u[body.at(centre)], len(body.free)


def main(folder):
    t = Tooth(z=50, m=3.0, x=0.0)
    rows, worst, dofs = [], 0.0, 0
    for radius in RADII:
        coarse, _ = deflections(t, radius, 1.25)
        fine, n = deflections(t, radius, 2.5)
        change = np.abs(coarse / fine - 1).max()
        worst, dofs = max(worst, change), max(dofs, n)
        print(f"{radius:7.3f} mm  {fine * 1e3} um  change {change:.1e}  {n} degrees of freedom", flush=True)
        rows.append((radius, *fine))
    columns = "radius_mm," + ",".join(f"deflection_um_at_half_width_{a:.2f}_mm" for a in HALF_WIDTHS)
    table = [[f"{row[0]:.3f}", *(f"{v * 1e3:.6f}" for v in row[1:])] for row in rows]
    write_table(folder, columns, table, RECORD.format(dofs=dofs, worst=worst))


RECORD = '''title = "Flank deflection of a gear in plane strain, seven radii"
kind = "computed"
source = "tools/reference/plane_gear.py: own tooth geometry and mesh (gmsh), finite elements by scikit-fem; not measured"

[gear]
teeth = 50
module_mm = 3.0
pressure_angle_deg = 20.0
profile_shift = 0.0
addendum = 1.0
dedendum = 1.25
rack_tip_radius = 0.38
bore_diameter_mm = 60.0
young_GPa = 206.0
poisson = 0.3

[load]
line_load_N_per_mm = 100.0
distribution = "Hertz pressure of the stated half width on the right flank of one tooth, centred at the radius, along the normal there"

[columns]
radius_mm = "radius of the load's centre"
"deflection_um_at_half_width_0.06_mm" = "displacement of the load's centre along the inward normal, bore fixed"
"deflection_um_at_half_width_0.12_mm" = "the same under a pressure twice as wide"

[method]
state = "plane strain, whole gear"
elements = "quadratic triangles with straight edges, at most {dofs} degrees of freedom"
grading = "0.003 mm at the load (a twentieth of the smaller half width), growing by 4 % of the distance; at most 0.1 mm on the loaded tooth, 1 mm in the body"
error_estimate = "all element sizes doubled change the deflections by at most {worst:.1e}; the order seen is 1.7, so that the error left is half of that, towards too stiff"
'''

if __name__ == "__main__":
    main(sys.argv[1])
