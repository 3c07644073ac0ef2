"""Draws the largest error over the processor time of every setting: accuracy_plot.py PANELS.json PICTURE.

A panel for each scene: single knobs lowered, knobs together, and the settings that are recommended.
"""

import json
import math
import sys

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "accuracy-cost"  # the same points give the same file
import matplotlib.pyplot as plt  # noqa: E402


def point(setting: dict) -> tuple[float, float]:
    return setting["cpu_s"], 100 * max(setting["errors"].values())


def main() -> None:
    with open(sys.argv[1], encoding="utf-8") as file:
        panels = json.load(file)
    columns = max(1, min(3, len(panels)))
    rows = max(1, math.ceil(len(panels) / columns))
    figure, axes = plt.subplots(rows, columns, figsize=(4.4 * columns, 3.2 * rows), squeeze=False, layout="constrained")
    for axis in axes.flat[len(panels):]:
        axis.set_visible(False)
    for axis, panel in zip(axes.flat, panels):
        drawn = [one for one in panel["tried"] if point(one)[1] > 0]
        for alone, colour, name in ((True, "tab:gray", "one knob lowered"), (False, "tab:blue", "knobs together")):
            points = [point(one) for one in drawn if one["one_knob_alone"] == alone]
            if points:
                axis.plot(*zip(*points), "o", color=colour, markersize=4, label=name)
        points = [point(one["run_again"]) for one in panel["advice"]]
        points = [p for p in points if p[1] > 0]
        if points:
            axis.plot(*zip(*points), "D", color="tab:red", markersize=7, fillstyle="none", label="recommended")
        axis.axvline(panel["tried"][0]["cpu_s"], color="tab:gray", linewidth=1, linestyle=":", label="reference's time")
        for level in (1, 0.1):
            axis.axhline(level, color="tab:green", linewidth=0.6)
        axis.set_xscale("log")
        axis.set_yscale("log")
        # Rounding is not worth a decade.
        axis.set_ylim(bottom=max(axis.get_ylim()[0], 1e-3))
        axis.set_title(panel["title"], fontsize=8)
        axis.set_xlabel("processor time s", fontsize=8)
        axis.set_ylabel("largest error %", fontsize=8)
        axis.tick_params(labelsize=7)
    axes.flat[0].legend(fontsize=7)
    figure.savefig(sys.argv[2], metadata={"Date": None})


if __name__ == "__main__":
    main()
