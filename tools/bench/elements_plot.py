"""Draws the largest error over the time of a reduction: elements_plot.py POINTS.json PICTURE.

Points are {space, element, flank_mm, local, wall_s, worst}; one panel for each space, a colour for each local term, a marker
for each element, a line through the mesh sizes.
"""

import json
import sys

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "elements"  # the same points give the same file
import matplotlib.pyplot as plt  # noqa: E402

COLOURS = {"none": "tab:gray", "weber-banaschek": "tab:orange", "calibrated": "tab:blue"}
MARKERS = {"hex8": "s", "hex8-incompatible": "o", "hex20": "^"}


def main() -> None:
    with open(sys.argv[1], encoding="utf-8") as file:
        points = json.load(file)
    spaces = list(dict.fromkeys(p["space"] for p in points))
    figure, axes = plt.subplots(1, len(spaces), figsize=(10, 4.6), sharey=True, squeeze=False, layout="constrained")
    for axis, space in zip(axes[0], spaces):
        for local, colour in COLOURS.items():
            for element, marker in MARKERS.items():
                line = [p for p in points if (p["space"], p["local"], p["element"]) == (space, local, element)]
                if not line:
                    continue
                axis.plot(
                    [p["wall_s"] for p in line], [100 * p["worst"] for p in line],
                    color=colour, marker=marker, markersize=5, linewidth=1, label=f"{local}, {element}",
                )
                if local == "calibrated":
                    for p in (line[0], line[-1]):
                        axis.annotate(
                            f"{p['flank_mm']:g}", (p["wall_s"], 100 * p["worst"]), fontsize=7,
                            xytext=(4, 4), textcoords="offset points",
                        )
        axis.set(title=space, xlabel="time of `gearmesh reduce` [s]", xscale="log", yscale="log")
        axis.grid(which="both", linewidth=0.3)
        for scale in (axis.xaxis, axis.yaxis):
            scale.set_major_formatter("{x:g}")
            scale.set_minor_formatter("")
    axes[0][0].set_ylabel("largest error of the deflection [%]")
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=8)
    figure.savefig(sys.argv[2], metadata={"Date": None})


if __name__ == "__main__":
    main()
