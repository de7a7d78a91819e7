"""A picture of the web viewer: vsgraphs view RUN --web in one terminal, this in another.

    tools/view_screenshot.py PAGE_ADDRESS OUT.png [--size 1280x800] [--settle 300] [--colours 256]

Needs Chromium (Debian: chromium) but neither display nor GPU. Speaks the DevTools protocol over its pipe: a
one-shot --screenshot is taken before the viewer has drawn anything. --colours: of the PNG's palette, 0: all.
"""

from __future__ import annotations

import argparse
import base64
import io
import json
import os
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any

from PIL import Image

_BEFORE_S, _BETWEEN_S, _SAME = 15.0, 8.0, 2
_BROWSERS = ("chromium", "chromium-browser", "google-chrome")
_FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--hide-scrollbars",
    "--remote-debugging-pipe",
)


class Browser:
    """A headless browser on file descriptors 3 (to it) and 4 (from it), messages ended by a zero byte."""

    def __init__(self, size: tuple[int, int], profile: str) -> None:
        to_browser, self._to = os.pipe()
        self._from, from_browser = os.pipe()
        self._received = b""
        self._number = 0
        name = next((name for name in _BROWSERS if _installed(name)), None)
        if name is None:
            raise SystemExit(f"none of {', '.join(_BROWSERS)} is installed")

        def connect() -> None:  # both ends may already be called 3 and 4
            high = [os.dup(fd) for fd in (to_browser, from_browser)]
            for high_fd, low_fd in zip(high, (3, 4), strict=True):
                os.dup2(high_fd, low_fd)

        window = f"--window-size={size[0]},{size[1]}"
        self._process = subprocess.Popen(
            [name, *_FLAGS, window, f"--user-data-dir={profile}", "about:blank"],
            preexec_fn=connect,  # noqa: PLW1509
            close_fds=False,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(to_browser)
        os.close(from_browser)

    def call(self, method: str, session: str | None = None, **parameters: Any) -> dict[str, Any]:
        """One call and its answer; events in between are passed over."""
        self._number += 1
        message: dict[str, Any] = {"id": self._number, "method": method, "params": parameters}
        if session is not None:
            message["sessionId"] = session
        os.write(self._to, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._next()
            if answer.get("id") == self._number:
                if "error" in answer:
                    raise SystemExit(f"{method}: {answer['error']}")
                result: dict[str, Any] = answer["result"]
                return result

    def _next(self) -> dict[str, Any]:
        while b"\0" not in self._received:
            part = os.read(self._from, 1 << 16)
            if not part:
                raise SystemExit("the browser ended")
            self._received += part
        line, _, self._received = self._received.partition(b"\0")
        answer: dict[str, Any] = json.loads(line)
        return answer

    def close(self) -> None:
        """Ends the browser."""
        self.call("Browser.close")
        try:
            self._process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            self._process.kill()


def _installed(name: str) -> bool:
    return any((Path(folder) / name).is_file() for folder in os.environ.get("PATH", "").split(":"))


def screenshot(address: str, size: tuple[int, int], settle_s: float) -> Image.Image:
    """Opens the page, waits until it has settled, and takes its picture."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(size, profile)
        target = browser.call("Target.createTarget", url="about:blank")["targetId"]
        session = browser.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        browser.call(
            "Emulation.setDeviceMetricsOverride",
            session,
            width=size[0],
            height=size[1],
            deviceScaleFactor=1,
            mobile=False,
        )
        dark = [{"name": "prefers-color-scheme", "value": "dark"}]
        browser.call("Emulation.setEmulatedMedia", session, features=dark)
        browser.call("Page.navigate", session, url=address)
        picture = _settled(browser, session, settle_s)
        browser.close()
    return picture


def _settled(browser: Browser, session: str, longest_s: float) -> Image.Image:
    """The page once three pictures in a row are the same, or as it is after longest_s."""
    deadline = time.monotonic() + longest_s
    same, last = 0, b""
    time.sleep(_BEFORE_S)
    while True:
        data = browser.call("Page.captureScreenshot", session, format="png")["data"]
        picture = Image.open(io.BytesIO(base64.b64decode(data))).convert("RGB")
        small = picture.crop((0, picture.height // 12, *picture.size)).resize((80, 50)).tobytes()
        same = same + 1 if small == last else 0
        last = small
        if same >= _SAME or time.monotonic() > deadline:
            return picture
        time.sleep(_BETWEEN_S)


def main() -> None:
    """Takes the picture."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("address")
    parser.add_argument("out", type=Path)
    parser.add_argument("--size", default="1280x800")
    parser.add_argument("--settle", type=float, default=300.0, help="seconds it may take at most")
    parser.add_argument("--colours", type=int, default=256)
    options = parser.parse_args()
    width, height = (int(number) for number in options.size.split("x"))
    address = options.address + ("" if "renderer=" in options.address else "&renderer=webgl")
    picture = screenshot(address, (width, height), options.settle)
    if options.colours:
        picture = picture.quantize(options.colours, dither=Image.Dither.NONE)
    picture.save(options.out, optimize=True)


if __name__ == "__main__":
    main()
