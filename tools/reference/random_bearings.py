"""Bearings drawn at random, at rest: where `gearmesh bearing` finds the inner ring beside bearings.py and bearing_types.py, which share no code with it.

    python random_bearings.py PROGRAM FIRST COUNT

Deep-groove, angular-contact (one row and pairs), four-point, thrust ball, cylindrical and spherical roller bearings in turn, each from a seed of its own, which
the lines name. The models here begin where the program has ended: their equations decide whether the ring rests there. A line is printed for each that is refused, found by one of the two only, or more than 1e-6 of its displacement apart; then numbers and largest
deviations by kind.
"""

import json
import random
import subprocess
import sys
from math import acos, atan2, cos, hypot, pi, radians, sin, tan
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from bearing_types import angular, four_point, rest, spherical, thrust
from bearings import Rollers, solve_rollers

KINDS = ("deep-groove", "angular-contact", "pair", "four-point", "thrust-ball", "cylindrical-roller", "spherical-roller")
APART = 1e-6


def text_of(**keys):
    return "".join(f"{key} = {json.dumps(value)}\n" for key, value in dict(name="drawn", **keys).items())


class Drawn:
    """A bearing's file, its load, its tilt where it is held, and where the inner ring rests by the models here [mm]."""

    def __init__(self, seed):
        self.kind = KINDS[seed % len(KINDS)]
        draw = random.Random(seed)
        D = draw.uniform(4, 25)
        dm = D * draw.uniform(3.2, 8)
        most = int(pi * dm / (1.05 * D))
        Z = draw.randint(max(4, most // 2), most)
        capacity = 10 * D**2 * Z**0.6
        size, around, up = capacity * 10 ** draw.uniform(-3, -0.7), draw.uniform(0, 2 * pi), draw.uniform(-pi / 2, pi / 2)
        self.force = [size * cos(up) * cos(around), size * cos(up) * sin(around), size * sin(up)]
        self.tilt = None
        if self.kind == "cylindrical-roller":
            self.cylindrical(draw, Z, D, dm)
        elif self.kind == "spherical-roller":
            self.spherical(draw, D)
        else:
            self.balls(draw, Z, D, dm, capacity)

    def cylindrical(self, draw, Z, D, dm):
        L, play = D * draw.uniform(0.9, 1.4), draw.choice([0, 0.01, 0.04])
        self.force = [3 * self.force[0], 3 * self.force[1], 0.0]
        self.tilt = (draw.uniform(-0.3, 0.3), draw.uniform(-0.3, 0.3))
        self.text = text_of(kind=self.kind, rollers=Z, roller_diameter_mm=D, roller_length_mm=L, pitch_diameter_mm=dm, radial_clearance_um=1e3 * play)
        tilt = [1e-3 * t for t in self.tilt]
        self.place = lambda start: solve_rollers(Rollers(Z, D, L, dm, play), self.force[:2], tilt=tilt, guess=start[:2], methods=("hybr",) * 3)[0][:2]

    def spherical(self, draw, D):
        alpha, L, dm, play = draw.uniform(6, 14), D * draw.uniform(0.5, 0.7), D * draw.uniform(5.5, 8), draw.choice([0, 0.04])
        Z = int(pi * dm / (1.1 * D))
        self.force = [3 * f for f in self.force]
        sizes = dict(rollers=Z, roller_diameter_mm=D, roller_length_mm=L, pitch_diameter_mm=dm)
        self.text = text_of(kind=self.kind, **sizes, contact_angle_deg=alpha, radial_clearance_um=1e3 * play)
        self.by_energy(spherical(Z, D, L, dm, radians(alpha), play=play), (0.0, 0.0))

    def balls(self, draw, Z, D, dm, capacity):
        fi, fo = draw.uniform(0.51, 0.54), draw.uniform(0.51, 0.54)
        sizes = (Z, D, dm, fi, fo)
        keys = dict(balls=Z, ball_diameter_mm=D, pitch_diameter_mm=dm, inner_conformity=fi, outer_conformity=fo)
        across = hypot(*self.force[:2])
        if self.kind == "deep-groove":
            play = draw.choice([0, 0.005, 0.02, 0.06])
            keys["radial_clearance_um"] = 1e3 * play
            rows = [angular(*sizes, acos(1 - play / (2 * (fi + fo - 1) * D)), 0)]
        elif self.kind == "thrust-ball":
            self.force[2] = max(abs(self.force[2]), 4 * across, 0.01 * capacity)
            rows = [thrust(*sizes)]
        else:
            alpha = draw.uniform(12, 40)
            keys["contact_angle_deg"] = alpha
            if self.kind == "four-point":
                play = draw.choice([0, 0.01])
                keys["radial_clearance_um"] = 1e3 * play
                rows = [four_point(*sizes, radians(alpha), play)]
            elif self.kind == "angular-contact":
                self.force[2] = max(abs(self.force[2]), 1.5 * tan(radians(alpha)) * across)
                rows = [angular(*sizes, radians(alpha))]
            else:
                apart, arrangement, preload = D * draw.uniform(1.1, 2.5), draw.choice("OX"), draw.choice([0, 2, 8])
                keys.update(arrangement=arrangement, row_distance_mm=apart, preload_um=preload)
                senses = (1, -1) if arrangement == "O" else (-1, 1)
                rows = [angular(*sizes, radians(alpha), sense, z) for sense, z in zip(senses, (-apart / 2, apart / 2))]
                for row, sense in zip(rows, senses):
                    [(circle, z, arm, stiffness, test)] = row.inner
                    row.inner = [(circle, z + 1e-3 * preload * sense, arm, stiffness, test)]
        self.text = text_of(kind="angular-contact" if self.kind == "pair" else self.kind, **keys)
        held = self.kind != "pair" and draw.random() < 0.4
        self.by_energy(rows, (draw.uniform(-2, 2), draw.uniform(-2, 2)) if held else None)

    def by_energy(self, rows, tilt):
        self.tilt = tilt
        self.place = lambda start: rest(rows, self.force, q=start, held=(3, 4) if tilt else ())[0][:3]


def found_by(program, drawn, folder):
    """Displacement and tilt of the ring [mm, rad], and the last line of what is said else."""
    file = Path(folder) / "drawn.toml"
    file.write_text(drawn.text)
    command = [program, "bearing", file, "--json", "--load-N=" + ",".join(map(repr, drawn.force))]
    if drawn.tilt:
        command.append("--tilt-mrad=" + ",".join(map(repr, drawn.tilt)))
    run = subprocess.run(command, capture_output=True, text=True, timeout=60)
    if run.returncode:
        assert run.returncode in (1, 2), run.stderr
        return None, run.stderr.strip().splitlines()[-1]
    found = json.loads(run.stdout)
    return 1e-3 * np.array(found["displacement_um"] + found["tilt_mrad"]), ""


def main():
    program, first, count = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    tally, largest = {}, {}
    with TemporaryDirectory() as folder:
        for seed in range(first, first + count):
            drawn = Drawn(seed)
            ours, why = found_by(program, drawn, folder)
            try:
                theirs = None if ours is None else np.array(drawn.place(ours))
            except (AssertionError, ValueError, np.linalg.LinAlgError) as error:
                theirs, why = None, f"{why} the model here: {error!r}"
            if ours is None or theirs is None:
                what = "not found" if ours is None else "not compared"
                print(seed, drawn.kind, what, why)
            else:
                what = "compared"
                apart = np.linalg.norm(ours[: len(theirs)] - theirs) / np.linalg.norm(theirs)
                largest[drawn.kind] = max(apart, largest.get(drawn.kind, 0.0))
                if apart > APART:
                    print(seed, drawn.kind, f"{apart:.1e} apart", ours, theirs)
            tally[drawn.kind, what] = tally.get((drawn.kind, what), 0) + 1
    for (kind, what), number in sorted(tally.items()):
        print(f"{kind}: {number} {what}" + (f", {largest[kind]:.1e} apart at most" if what == "compared" else ""))


if __name__ == "__main__":
    main()
