"""Draws the largest error over the processor time of every setting: accuracy_plot.py PANELS.json PICTURE.

A panel for each scene: each knob lowered by itself, knobs together, and the settings that are recommended.
"""

import json
import math
import sys

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "accuracy-cost"  # the same points give the same file
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402


# Distinct with all kinds of sight, as far as there are so many (Okabe and Ito, Color universal design, 2008).
COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#8C6D1F", "#000000", "#6A3D9A", "#33A02C", "#882255", "#44AA99", "#999933", "#CC6677"]


def knob_of(setting: dict) -> str:
    """The knob that one is lowered alone; the same for a mesh of a pair and of a scene."""
    return setting["setting"].split(" = ")[0].removeprefix("gear_")


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
    colours: dict[str, str] = {}
    for axis, panel in zip(axes.flat, panels):
        drawn = [one for one in panel["tried"] if point(one)[1] > 0]
        alone = [one for one in drawn if one["one_knob_alone"]]
        # A colour a knob, its rungs joined.
        for knob in sorted({knob_of(one) for one in alone}):
            points = sorted(point(one) for one in alone if knob_of(one) == knob)
            colour = colours.setdefault(knob, COLOURS[len(colours) % len(COLOURS)])
            axis.plot(*zip(*points), "o-", color=colour, markersize=4, linewidth=0.8)
        points = [point(one) for one in drawn if not one["one_knob_alone"]]
        if points:
            axis.plot(*zip(*points), ".", color="tab:gray", markersize=4)
        points = [point(one["run_again"]) for one in panel["advice"]]
        points = [p for p in points if p[1] > 0]
        if points:
            axis.plot(*zip(*points), "D", color="tab:red", markersize=7, fillstyle="none")
        axis.axvline(panel["tried"][0]["cpu_s"], color="tab:gray", linewidth=1, linestyle=":")
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
    shown = [Line2D([], [], color=colour, marker="o", markersize=4, linewidth=0.8, label=knob) for knob, colour in colours.items()]
    shown.append(Line2D([], [], color="tab:gray", marker=".", linestyle="", label="knobs together"))
    shown.append(Line2D([], [], color="tab:red", marker="D", fillstyle="none", linestyle="", label="recommended"))
    shown.append(Line2D([], [], color="tab:gray", linestyle=":", label="reference's time"))
    figure.legend(handles=shown, fontsize=7, loc="outside lower center", ncols=4)
    figure.savefig(sys.argv[2], metadata={"Date": None})


if __name__ == "__main__":
    main()
