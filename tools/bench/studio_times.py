"""From the event of a slider to the picture: percentiles over many moves, the server's part and the browser's apart.

    python tools/bench/studio_times.py target/debug/gearmesh pair.toml [KEY] [MOVES]
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests/python"))
import studio_page  # noqa: E402  (stands in that folder)


def main(program, scene, key="gear_1.microgeometry.tip_relief_um", moves="60"):
    with studio_page.server(program, scene) as address, studio_page.browser() as browser:
        it = studio_page.Page(browser, address)
        it.wait()
        for move in range(int(moves)):
            it.slide(key, 5.0 + 0.5 * (move % 40))
            it.wait(move + 2)
        times = it.times()[5:]
        answer = it.answer()
    shape = f"{answer['slices']} slices x {len(answer['angle_deg'])} positions x {len(answer['torques_Nm'])} torques"
    spent = {
        "calculation": [1e3 * one["server"] for one in times],
        "request and answer": [one["received"] - one["sent"] for one in times],
        "curves and tables": [one["drawn"] - one["received"] for one in times],
        "event to script's end": [one["drawn"] - one["event"] for one in times],
        "event to picture": [one["painted"] - one["event"] for one in times],
    }
    print(f"{shape}, {len(times)} moves of {key}; ms")
    print(f"{'':24}{'p50':>8}{'p90':>8}{'p99':>8}")
    for name, values in spent.items():
        print(f"{name:24}" + "".join(f"{value:8.1f}" for value in np.percentile(values, [50, 90, 99])))


if __name__ == "__main__":
    main(*sys.argv[1:])
