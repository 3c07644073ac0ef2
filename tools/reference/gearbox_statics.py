"""Bearing forces of shipped gearboxes by hand: reference/gearbox_three_stage/data.csv (fe_models/gearbox_three_stage.toml, its reduced gears
alike) and reference/gearbox_23_47/data.csv (fe_models/gearbox_23_47.toml).

    python gearbox_statics.py three_stage --out ../../reference/gearbox_three_stage
    python gearbox_statics.py 23_47 --out ../../reference/gearbox_23_47

Independent of the Rust code: nothing but equilibrium. Every mesh acts by F_t, F_r and F_a in the pitch point, in the middle of the
width that its two faces share. Each shaft stands on two bearings, of which one also carries along the axis: determinate.

    F_t = T/r_w,  r_w1 = a z1/(z1 + z2),  F_r = F_t tan(alpha_wt),  cos(alpha_wt) = (r_b1 + r_b2)/a,  F_a = F_t tan(beta) r_w/r

Signs: a driver that turns clockwise seen from +z (s = -1) and is right-handed (h = +1) pushes its wheel to +z: F_z = -h s F_a. The
tangential force on the wheel points where the driver's teeth move in the pitch point, the radial one away from the driver.
"""

import argparse
import csv
import pathlib
from math import acos, atan, cos, radians, sin, sqrt, tan

NORMAL_PRESSURE_ANGLE = radians(20.0)

# Shafts: angles of the centre lines against x; places of the bearings that locate and that float.
# Stages: teeth, normal module, helix angle, hand of the driver, centre distance; each face as middle and width.
GEARBOXES = {
    "three_stage": dict(
        output_torque_Nm=1200.0,
        centre_lines_deg=(0.0, 70.0, -10.0),
        bearings_mm=((0.0, 60.0), (0.0, 110.0), (50.0, 190.0), (95.0, 195.0)),
        stages=(
            dict(teeth=(17, 59), module=2.0, helix=20.0, hand=+1, distance=80.92, faces=((30.0, 24.0), (31.0, 19.0))),
            dict(teeth=(19, 67), module=2.5, helix=15.0, hand=-1, distance=111.34, faces=((80.0, 34.0), (80.0, 30.0))),
            dict(teeth=(21, 73), module=3.5, helix=14.0, hand=+1, distance=169.60, faces=((145.0, 50.0), (145.0, 45.0))),
        ),
    ),
    "23_47": dict(
        output_torque_Nm=200.0,
        centre_lines_deg=(0.0,),
        bearings_mm=((0.0, 80.0), (0.0, 80.0)),
        stages=(dict(teeth=(23, 47), module=3.0, helix=0.0, hand=+1, distance=105.04, faces=((30.0, 20.0), (30.0, 20.0))),),
    ),
}


def shared_middle(faces):
    """Middle of what two faces share along z."""
    low = max(middle - 0.5 * width for middle, width in faces)
    high = min(middle + 0.5 * width for middle, width in faces)
    return 0.5 * (low + high)


def forces(gearbox):
    """Axes of the shafts [m] and, for each, its loads (place, force on the shaft)."""
    axes = [(0.0, 0.0)]
    for stage, angle in zip(gearbox["stages"], gearbox["centre_lines_deg"]):
        x, y = axes[-1]
        a = stage["distance"] * 1e-3
        axes.append((x + a * cos(radians(angle)), y + a * sin(radians(angle))))
    loads = [[] for _ in axes]
    torque = gearbox["output_torque_Nm"]
    for number in reversed(range(len(gearbox["stages"]))):
        stage = gearbox["stages"][number]
        z1, z2 = stage["teeth"]
        a, helix = stage["distance"] * 1e-3, radians(stage["helix"])
        pressure = atan(tan(NORMAL_PRESSURE_ANGLE) / cos(helix))
        reference = [0.5e-3 * stage["module"] * z / cos(helix) for z in (z1, z2)]
        pitch = [a * z / (z1 + z2) for z in (z1, z2)]
        working = acos(sum(reference) * cos(pressure) / a)
        tangential = torque / pitch[1]
        radial = tangential * tan(working)
        axial = tangential * tan(helix) * pitch[1] / reference[1]
        turning = -1.0 if number % 2 == 0 else 1.0
        angle = radians(gearbox["centre_lines_deg"][number])
        away = (cos(angle), sin(angle))
        along = (-turning * away[1], turning * away[0])
        force = [tangential * t + radial * r for t, r in zip(along, away)] + [-stage["hand"] * turning * axial]
        z = shared_middle(stage["faces"]) * 1e-3
        loads[number].append(((pitch[0] * away[0], pitch[0] * away[1], z), [-f for f in force]))
        loads[number + 1].append(((-pitch[1] * away[0], -pitch[1] * away[1], z), force))
        print(f"stage {number + 1}: F_t {tangential:.1f} N, F_r {radial:.1f} N, F_a {axial:.1f} N")
        torque *= z1 / z2
    print(f"input torque {torque:.4f} N m")
    return loads


def reactions(loads, locating_m, floating_m):
    """Forces of both bearings on the shaft: moments about the locating one, which carries along the axis."""
    span = floating_m - locating_m
    moment = [0.0, 0.0]
    total = [0.0, 0.0, 0.0]
    for (x, y, z), force in loads:
        arm = z - locating_m
        moment[0] += y * force[2] - arm * force[1]
        moment[1] += arm * force[0] - x * force[2]
        total = [t + f for t, f in zip(total, force)]
    floating = [-moment[1] / span, moment[0] / span, 0.0]
    locating = [-t - f for t, f in zip(total, floating)]
    return locating, floating


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("gearbox", choices=GEARBOXES)
    parser.add_argument("--out", type=pathlib.Path)
    arguments = parser.parse_args()
    gearbox, out = GEARBOXES[arguments.gearbox], arguments.out
    rows = []
    for shaft, (loads, places) in enumerate(zip(forces(gearbox), gearbox["bearings_mm"])):
        both = reactions(loads, *(z * 1e-3 for z in places))
        for name, force in zip("AB", both):
            size = sqrt(sum(f * f for f in force))
            print(f"bearing {shaft + 1}{name}: {force[0]:9.1f} {force[1]:9.1f} {force[2]:9.1f} N, {size:8.1f} N")
            rows.append([f"bearing {shaft + 1}{name}"] + [f"{f + 0.0:.3f}" for f in force])
    if out:
        with open(out / "data.csv", "w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["bearing", "force_x_N", "force_y_N", "force_z_N"])
            writer.writerows(rows)


if __name__ == "__main__":
    main()
