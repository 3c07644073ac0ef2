"""Draws pairs A and B with and without friction: lightweight_gears_plot.py RESULTS RECORDS PICTURE.

RESULTS: folder with pair_a.h5, pair_a_friction.h5, pair_b.h5, pair_b_friction.h5 (`gearmesh run fe_models/NAME.toml`);
RECORDS: `reference`. Transmission error over two pitches, root strain over the pass of the gauge's tooth.
"""

import csv
import sys
from pathlib import Path

import h5py
import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "lightweight-gears"  # the same curves give the same file
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

TEETH = 57


class Result:
    """Even and further positions of one file, by torque."""

    def __init__(self, path: Path) -> None:
        with h5py.File(path) as file:
            self.torques = [round(float(t)) for t in file["torque_Nm"][:]]
            self.even = np.degrees(file["angle_rad"][:])
            count = file["between/count"][:]
            self.ends = np.concatenate([[0], np.cumsum(count)]).astype(int)
            self.between = np.degrees(file["between/angle_rad"][:])
            self.curves = {"te": self._curves(1e6, file["te_m"], file["between/te_m"])}
            for gauge in file["gauges"].values():
                name = gauge["name"][()].decode()
                for method in (1, 2):
                    own = (gauge[f"method_{method}"], gauge[f"between_method_{method}"])
                    self.curves[name, method] = self._curves(1e6, *own)

    def _curves(self, factor, even, between):
        """Angles and values of each torque. Positions between the even ones have values in each period of the mesh."""
        between = between[:].reshape(len(self.between), -1)
        periods = 360 / between.shape[1] * np.arange(between.shape[1])  # the run has one revolution
        curves = []
        for values, a, b in zip(even[:].reshape(len(self.torques), -1), self.ends, self.ends[1:]):
            angle = np.concatenate([self.even, np.add.outer(self.between[a:b], periods).ravel()])
            order = np.argsort(angle, kind="stable")
            curves.append((angle[order], factor * np.concatenate([values, between[a:b].ravel()])[order]))
        return curves

    def curve(self, key, torque: int) -> tuple[np.ndarray, np.ndarray]:
        return self.curves[key][self.torques.index(torque)]


def record(folder: Path, head: str) -> tuple[np.ndarray, np.ndarray]:
    with open(folder / "data.csv", encoding="utf-8") as file:
        rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
    data = np.array([[float(row[0]), float(row[rows[0].index(head)])] for row in rows[1:]])
    return data[:, 0], data[:, 1]


def about_zero(angle, values):
    """The turn from -180 to 180 degrees: tooth 0 passes at 0."""
    angle = np.where(angle > 180, angle - 360, angle)
    order = np.argsort(angle, kind="stable")
    return angle[order], values[order]


def main() -> None:
    results, records, picture = (Path(word) for word in sys.argv[1:4])
    load = lambda name: Result(results / f"{name}.h5")
    pairs = {p: (load(f"pair_{p}"), load(f"pair_{p}_friction"), records / f"pair_{p}_friction") for p in "ab"}
    figure, axes = plt.subplots(4, 2, figsize=(10, 12), layout="constrained")
    pitch = 360 / TEETH
    for axis, (torque, seed) in zip(axes[0], ((50, "8a"), (300, "8b"))):
        free, rough, folder = pairs["a"]
        for result, style, label in ((free, "tab:gray", "without friction"), (rough, "tab:blue", "μ = 0.3")):
            axis.plot(*result.curve("te", torque), color=style, label=label)
        axis.plot(*record(folder, f"te_um_{torque}Nm"), "k:", label="record, μ = 0.3")
        axis.set(title=f"pair A, {torque} N m (figure {seed})", xlim=(0, 2 * pitch), xlabel="driver angle, deg", ylabel="TE, um")
        axis.legend(fontsize=7)
    panels = (("a", 50, "t0_tension", "13"), ("a", 50, "t0_compression", "13"), ("a", 300, "t0_tension", "14"),
              ("a", 300, "t0_compression", "14"), ("b", 300, "t0_tension", "16"), ("b", 300, "t9_tension", "17"))
    for axis, (pair, torque, gauge, seed) in zip(axes[1:].flat, panels):
        free, rough, folder = pairs[pair]
        centre = 0 if gauge.startswith("t0") else -9 * pitch
        for result, key, style, label in (
            (free, 1, dict(color="tab:orange", linestyle="--"), "method 1, no friction"),
            (free, 2, dict(color="tab:gray"), "method 2, no friction"),
            (rough, 2, dict(color="tab:blue"), "method 2, μ = 0.3"),
        ):
            angle, values = about_zero(*result.curve((gauge, key), torque))
            axis.plot(angle, values, label=label, **style)
        angle, values = about_zero(*record(folder, f"strain_{gauge}_ustrain_{torque}Nm"))
        axis.plot(angle, values, "k:", label="record, μ = 0.3")
        axis.set(title=f"pair {pair.upper()}, {torque} N m, {gauge.replace('_', ' ')} (figure {seed})",
                 xlim=(centre - 2 * pitch, centre + 2 * pitch), xlabel="driver angle, deg", ylabel="strain, ustrain")
        axis.legend(fontsize=7)
    figure.savefig(picture, metadata={"Date": None})


if __name__ == "__main__":
    main()
