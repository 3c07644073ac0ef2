"""The studio for tests and the bench: its server as a process, its page in the Chromium of the distribution."""

import contextlib
import json
import os
import shutil
import subprocess
import threading
import time
from pathlib import Path

import psutil

PROGRAM = os.environ.get("GEARMESH_PROGRAM", "target/debug/gearmesh")
# Where distributions put the browser.
NAMES = ("chromium", "chromium-browser", "google-chrome")
# So long a server or a browser may take to begin or to end.
END_S = 60.0
# WebGL without a graphics card; the page itself is put together as browsers do without one.
OPTIONS = ["--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--no-sandbox", "--disable-gpu-vsync", "--disable-gpu-compositing"]


def chromium():
    """Path of the browser; None where there is none."""
    return next((path for path in map(shutil.which, NAMES) if path), None)


@contextlib.contextmanager
def server(program, file=None, folder=None, beside=None):
    """The address of a server of `file`, or of something new in `folder`; it ends with the block."""
    words = [str(Path(program).absolute()), "studio", *([str(file)] if file else []), "--no-open"]
    words += ["--beside", str(beside)] if beside else []
    with subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            address = process.stdout.readline().strip()
            if not address.startswith("http://127.0.0.1:"):
                raise RuntimeError(process.stderr.read())
            yield address
        finally:
            process.terminate()
            try:
                process.wait(END_S)
            except subprocess.TimeoutExpired:
                process.kill()
                raise


def kill_browsers():
    """Kills the browsers that this process has started."""
    for process in psutil.Process().children(recursive=True):
        with contextlib.suppress(psutil.Error):
            if "chrom" in process.name():
                process.kill()


@contextlib.contextmanager
def killed_after(seconds):
    """Where the block takes longer, the browsers are killed: Playwright waits for some of its answers without end."""
    timer = threading.Timer(seconds, kill_browsers)
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


@contextlib.contextmanager
def browser():
    """A headless browser of Playwright."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=chromium(), args=OPTIONS)
        try:
            yield opened
        finally:
            with killed_after(END_S):
                opened.close()


class Page:
    """A page of the studio and what its console said."""

    def __init__(self, browser, address, width=1280, height=900, theme="light"):
        context = browser.new_context(viewport=dict(width=width, height=height), color_scheme=theme)
        self.page = context.new_page()
        self.complaints = []
        self.page.on("console", self.hear)
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.goto(address)

    def hear(self, said):
        """Keeps what the console complains of.

        Without a graphics card each picture of a WebGL canvas is read back, which the driver calls a stall.
        """
        if said.type in ("error", "warning") and "GPU stall due to ReadPixels" not in said.text:
            self.complaints.append(said.text)

    def wait(self, count=1):
        """Waits until so many answers were drawn and seen."""
        self.until(f"globalThis.gearmeshStudio?.times.length >= {count}")

    def until(self, condition, seconds=60.0):
        """Waits for a condition. Playwright's own wait compiles it in the page, which the policy of the page forbids."""
        end = time.monotonic() + seconds
        while not self.page.evaluate(condition):
            assert time.monotonic() < end, f"{condition} does not hold: {self.complaints} {self.page.locator('#problem').text_content()}"
            self.page.wait_for_timeout(10)

    def answer(self):
        return self.page.evaluate("globalThis.gearmeshStudio.answer")

    def times(self):
        return self.page.evaluate("globalThis.gearmeshStudio.times")

    def field(self, key):
        return self.page.locator(f".field[data-key='{key}']")

    def open_groups(self):
        self.page.evaluate("document.querySelectorAll('#form details').forEach((group) => (group.open = true))")

    def slide(self, key, value):
        """Moves a slider to a value as a hand does: it speaks while it moves, and once it is let go."""
        slider = self.field(key).locator("input[type=range]").first
        move = "(slider, value) => { slider.value = value; for (const kind of ['input', 'change']) slider.dispatchEvent(new Event(kind, {bubbles: true})); }"
        slider.evaluate(move, value)

    def colours(self, canvas):
        """Different colours of a canvas, as the browser has drawn it."""
        count = """(canvas) => {
            const copy = Object.assign(document.createElement('canvas'), {width: canvas.width, height: canvas.height});
            const context = copy.getContext('2d');
            context.drawImage(canvas, 0, 0);
            const {data} = context.getImageData(0, 0, copy.width, copy.height);
            const seen = new Set();
            for (let k = 0; k < data.length; k += 4) seen.add((data[k] << 24) | (data[k + 1] << 16) | (data[k + 2] << 8) | data[k + 3]);
            return seen.size;
        }"""
        return self.page.locator(canvas).evaluate(count)

    def keep(self, name):
        """A screenshot, where GEARMESH_KEEP_SCREENSHOTS names a folder."""
        folder = os.environ.get("GEARMESH_KEEP_SCREENSHOTS")
        if folder:
            self.page.screenshot(path=str(Path(folder) / f"{name}.png"), full_page=True)


def printed(program, scene, folder):
    """What `gearmesh run --json` prints for a scene, the clock left out."""
    words = [str(program), "run", str(scene), "-o", str(Path(folder) / "printed.h5"), "--json"]
    figures = json.loads(subprocess.run(words, capture_output=True, text=True, check=True).stdout)
    figures.pop("seconds")
    return figures
