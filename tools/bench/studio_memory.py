"""Memory of the studio's server while sliders move for long: its resident memory over the number of moves.

    python tools/bench/studio_memory.py target/debug/gearmesh pair.toml [MOVES]

A hand moves a slider about ten times a second: 36 000 moves are an hour. Reliefs, torques and slices take turns, and a link to another page
is followed now and then.
"""

import http.client
import json
import os
import subprocess
import sys
import time
import urllib.parse
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests/python"))
import studio_page  # noqa: E402  (stands in that folder)


def resident_mb(process):
    """Resident memory of a process [MB]."""
    pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
    return 1e-6 * pages * os.sysconf("SC_PAGE_SIZE")


def change(move):
    """What the page sends of a move."""
    settings = {
        "gear_1.microgeometry.tip_relief_um": 0.25 * (move % 240),
        "gear_1.microgeometry.tip_relief_start_diameter_mm": 72.0,
        "run.torques_Nm": [50.0, 100.0 + move % 50, 200.0],
    }
    if move % 10 == 0:
        settings["run.points_per_pitch"] = 20 + move % 30
    return json.dumps({"settings": settings})


def main(program, scene, moves="36000"):
    moves = int(moves)
    with studio_page.server(program, scene) as address:
        port = urllib.parse.urlsplit(address).port
        token = urllib.parse.parse_qs(urllib.parse.urlsplit(address).query)["token"][0]
        server = int(subprocess.run(["pgrep", "-f", f"^{program} studio {scene}"], capture_output=True, text=True, check=True).stdout.split()[0])
        link = http.client.HTTPConnection("127.0.0.1", port)
        head = {"X-Gearmesh-Token": token, "Content-Type": "application/json"}
        begun, sizes = time.monotonic(), []
        for move in range(moves + 1):
            link.request("POST", "/api/pair", change(move), head)
            reply = link.getresponse()
            size = len(reply.read())
            assert reply.status == 200, reply.status
            if move % max(1, moves // 12) == 0:
                sizes.append(resident_mb(server))
                print(f"{move:7} moves {time.monotonic() - begun:8.1f} s {sizes[-1]:8.1f} MB", flush=True)
    print(f"an answer has {1e-6 * size:.2f} MB; from the second reading on the memory grew by {sizes[-1] - sizes[1]:.1f} MB")


if __name__ == "__main__":
    main(*sys.argv[1:])
