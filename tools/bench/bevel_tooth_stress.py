"""Stress at places of a bevel pinion's teeth in a run: bevel_tooth_stress.py START.pvd STEADY.pvd TEETH PERIOD_S.

Both are of `gearmesh export RESULT -o NAME.pvd --stress`: START from the first moment on, STEADY some mesh periods at one speed. Prints tables for
docs/bevel-machines.md: von Mises stress at five places of the loaded flank over the passage of a tooth, its largest in the start, how long it is above 80 %,
the largest of each tooth, and along the face at the fillet. The stress is that of the finite elements, forces spread over them: no Hertz stress.
"""

import sys

import numpy as np
import pyvista


def moments(path):
    """Cells of the pinion at each moment: time, stress, whether they carry; and where they lie, from its first moment."""
    reader = pyvista.PVDReader(path)
    told = []
    place = tooth = None
    for at in reader.time_values:
        reader.set_active_time_value(at)
        mesh = reader.read()[0]
        mine = np.asarray(mesh.cell_data["gear"]) == 1
        if place is None:
            place = np.asarray(mesh.cell_centers().points)[mine].astype(float)
            tooth = np.asarray(mesh.cell_data["tooth"])[mine]
        loads = np.asarray(mesh.cell_data["line_load_N_per_m"])[mine]
        told.append((at, 1e-6 * np.asarray(mesh.cell_data["von_mises_Pa"])[mine].astype(float), loads > 0.0))
    times = np.array([at for at, _, _ in told])
    return times, np.array([s for _, s, _ in told]), np.array([c for _, _, c in told]), place, tooth


def shares(place):
    """Along the face from toe to heel, and up from root cone to tip cone, both 0 to 1; the pinion's axis is z, its apex the origin."""
    cone = np.linalg.norm(place, axis=1)
    angle = np.arctan2(np.hypot(place[:, 0], place[:, 1]), place[:, 2])
    along = (cone - cone.min()) / np.ptp(cone)
    up = np.empty_like(angle)
    bins = np.minimum((along * 10).astype(int), 9)
    for k in range(10):
        own = bins == k
        up[own] = (angle[own] - angle[own].min()) / np.ptp(angle[own])
    return along, up


class Tooth:
    """Cells of a tooth with their places on it, and which of them are on the side that carries."""

    def __init__(self, number, place, tooth, carries):
        self.cells = np.flatnonzero(tooth == number)
        own = place[self.cells]
        self.along, self.up = shares(own)
        azimuth = np.unwrap(np.sort(np.arctan2(own[:, 1], own[:, 0])))
        turn = 0.5 * (azimuth[0] + azimuth[-1])
        azimuth = (np.arctan2(own[:, 1], own[:, 0]) - turn + np.pi) % (2.0 * np.pi) - np.pi
        # The middle of the tooth winds about the axis along the face.
        middle = np.polyval(np.polyfit(self.along, azimuth, 2), self.along)
        loaded = carries[:, self.cells].any(axis=0)
        side = np.sign(np.mean((azimuth - middle)[loaded])) if loaded.any() else 1.0
        self.side = side * (azimuth - middle) > 0.0

    def near(self, along, up):
        """Cells of the loaded side at a place: a tenth of face and height around it."""
        own = self.side & (abs(self.along - along) < 0.1) & (abs(self.up - up) < 0.1)
        return self.cells[own]


PLACES = {
    "addendum, middle of the face": (0.5, 0.85),
    "toe, middle of the height": (0.08, 0.5),
    "middle of face and height": (0.5, 0.5),
    "dedendum, large end": (0.92, 0.15),
    "root, middle of the face": (0.5, 0.1),
}


def main() -> int:
    start, steady, count, period = sys.argv[1], sys.argv[2], int(sys.argv[3]), float(sys.argv[4])
    times, stress, carries, place, tooth = moments(steady)
    teeth = {k: Tooth(k, place, tooth, carries) for k in range(count)}
    passed = [k for k, one in teeth.items() if carries[:, one.cells].any()]
    loaded = {k: times[carries[:, teeth[k].cells].any(axis=1)] for k in passed}
    # Teeth that came and went within the window.
    whole = [k for k in passed if loaded[k].min() > times[0] + period and loaded[k].max() < times[-1] - period]
    print(f"{len(times)} moments, {1e3 * (times[-1] - times[0]):.2f} ms; teeth that pass: {whole}")
    begun_times, begun, begun_carries, begun_place, begun_tooth = moments(start)
    first = {k: Tooth(k, begun_place, begun_tooth, begun_carries) for k in range(count)}

    print("\n| place | largest over a passage MPa | in the start MPa | above 80 % of its peak, of the time in contact |\n| --- | ---: | ---: | ---: |")
    for name, at in PLACES.items():
        # Of all teeth together: each is met at other moments of its passage.
        passed_by = []
        for k in whole:
            inside = (times >= loaded[k].min()) & (times <= loaded[k].max())
            passed_by.extend(stress[inside][:, teeth[k].near(*at)].max(axis=1))
        passage = np.array(passed_by)
        most = max(begun[:, one.near(*at)].max() for one in first.values())
        print(f"| {name} | {passage.max():.0f} | {most:.0f} | {100.0 * (passage > 0.8 * passage.max()).mean():.0f} % |")

    print("\n| tooth |", " | ".join(str(k) for k in passed), "|\n|" + " --- |" * (len(passed) + 1))
    largest = [stress[:, teeth[k].cells].max() for k in passed]
    print("| largest MPa |", " | ".join(f"{s:.0f}" for s in largest), "|")

    print("\n| along the face, toe to heel |", " | ".join(f"{5 + 10 * k} %" for k in range(10)), "|\n|" + " --- |" * 11)
    rows = []
    for k in whole:
        one = teeth[k]
        foot = one.side & (one.up < 0.25)
        rows.append([stress[:, one.cells[foot & (abs(one.along - 0.05 - 0.1 * j) < 0.05)]].max() for j in range(10)])
    print("| largest at the fillet MPa |", " | ".join(f"{s:.0f}" for s in np.max(rows, axis=0)), "|")
    print(f"\nlargest of the start, any place: {begun.max():.0f} MPa at {1e3 * begun_times[begun.max(axis=1).argmax()]:.2f} ms; steady {stress.max():.0f} MPa")
    return 0


if __name__ == "__main__":
    sys.exit(main())
