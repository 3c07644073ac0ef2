"""From a changed field of a bevel pair to its curves and figures: percentiles over many changes.

    python tools/bench/studio_bevel_times.py target/debug/gearmesh bevel.toml [KEY] [CHANGES]
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests/python"))
import studio_page  # noqa: E402  (stands in that folder)


def main(program, scene, key="bevel.spiral_angle_deg", changes="30"):
    with studio_page.server(program, scene) as address, studio_page.browser() as browser:
        it = studio_page.Page(browser, address)
        it.until("globalThis.gearmeshLooks?.length >= 1")
        it.page.evaluate("for (const group of document.querySelectorAll('details')) group.open = true")
        field = it.field(key).locator("input[type=number]")
        stated = float(field.input_value())
        for change in range(int(changes)):
            field.fill(f"{stated * (1.0 - 0.002 * (change + 1)):.4f}")
            field.press("Enter")
            it.until(f"globalThis.gearmeshLooks.length >= {change + 2}")
        looks = it.page.evaluate("globalThis.gearmeshLooks")[1:]
    shown = ", ".join(f"p{share} {value:.0f}" for share, value in zip((50, 90, 99), np.percentile(looks, [50, 90, 99])))
    print(f"{len(looks)} changes of {key}, request to picture in ms: {shown}")


if __name__ == "__main__":
    main(*sys.argv[1:])
