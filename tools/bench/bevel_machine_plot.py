"""Draws a bevel machine in motion: bevel_machine_plot.py ROWS.csv PICTURE.svg, rows of `gearmesh export RESULT -o ROWS.csv`.

Orbit of the pinion's apex and paths of the cages over the second half of the run, spectra over the speed of the run-up (waterfall), root strain of both members.
"""

import csv
import sys

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "bevel-machine"  # the same rows give the same file
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

BEARINGS = ["pinion near", "pinion far", "gear near", "gear far"]
WINDOW = 250  # rows of a spectrum


def rows(path):
    with open(path, encoding="utf-8") as file:
        lines = [line for line in csv.reader(file) if line and not line[0].startswith("#")]
    return dict(zip(lines[0], np.array(lines[1:], dtype=float).T))


def orbits(axes, data, late):
    x, y = (1e6 * (data[f"bodies/pinion/{axis}_m"][late]) for axis in "xy")
    axes[0].plot(x - x.mean(), y - y.mean(), lw=0.6)
    axes[0].set(title="pinion's apex", xlabel="x µm", ylabel="y µm", aspect="equal")
    for name in BEARINGS:
        x, y = (1e3 * data[f"elements/{name}/cage_1_{axis}_m"][late] for axis in "xy")
        axes[1].plot(x, y, lw=0.8, label=name)
    axes[1].set(title="middles of the cages from their axes", xlabel="x mm", ylabel="y mm", aspect="equal")
    axes[1].legend(fontsize=7, loc="center left")


def waterfall(axis, data):
    times, force = data["time_s"], data["elements/pinion near/force_radial_N"]
    speed = data["bodies/pinion/angular_velocity_z_rad_per_s"] * 30.0 / np.pi
    starts = range(0, len(times) - WINDOW, WINDOW // 4)
    frequencies = np.fft.rfftfreq(WINDOW, times[1] - times[0])
    window = np.hanning(WINDOW)
    lines = [2.0 * abs(np.fft.rfft(window * (own - own.mean()))) / window.sum() for own in (force[k : k + WINDOW] for k in starts)]
    middles = [1e3 * times[k + WINDOW // 2] for k in starts]
    shown = frequencies < 8000.0
    picture = axis.pcolormesh(1e-3 * frequencies[shown], middles, np.log10(np.maximum(np.array(lines)[:, shown], 0.1)), shading="nearest", cmap="viridis", rasterized=True)
    for order in (1, 2, 3, 4):
        mesh = [13e-3 * order * abs(speed[k + WINDOW // 2]) / 60.0 for k in starts]
        axis.plot(mesh, middles, "w:", lw=0.8)
    axis.set(title="pinion's near bearing, radial force; dotted: mesh orders", xlabel="kHz", ylabel="time ms", xlim=(0.0, 8.0))
    plt.colorbar(picture, ax=axis, label="log10 of N")


def strain(axis, data, late):
    for number, name in ((1, "pinion"), (2, "gear")):
        axis.plot(1e3 * data["time_s"][late], data[f"elements/mesh/strain_gear{number}_root_method2_ustrain"][late], lw=0.7, label=name)
    axis.set(title="root strain of tooth 0, compression side", xlabel="time ms", ylabel="µε")
    axis.legend(fontsize=7)


def main() -> int:
    data = rows(sys.argv[1])
    late = data["time_s"] >= 0.5 * data["time_s"][-1]
    _, axes = plt.subplots(2, 2, figsize=(10.5, 8.5), layout="constrained")
    orbits(axes[0], data, late)
    waterfall(axes[1, 0], data)
    strain(axes[1, 1], data, late)
    plt.savefig(sys.argv[2], metadata={"Date": None}, dpi=110)
    return 0


if __name__ == "__main__":
    sys.exit(main())
