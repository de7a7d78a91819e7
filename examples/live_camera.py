"""A source of one's own, live: `python examples/live_camera.py FOLDER RESULTS`.

The folder stands where a camera's driver would: it hands out images at its own pace, whether somebody takes
them or not. Ctrl-C ends the run and keeps the results.
"""

import sys
import time
from collections.abc import Iterator
from typing import Any

import vsgraphs
from vsgraphs.sources import ImageFrame


class LiveCamera:
    """What a source must have is `camera` and `frames`; `live` says that nobody can wait for it."""

    live = True

    def __init__(self, folder: str, speed: float = 1.0) -> None:
        self._recording = vsgraphs.open_sequence(folder)
        self._speed = speed
        self.info = {"name": "live camera"}

    @property
    def camera(self) -> Any:
        """Its numbers: vsgraphs.Camera(width, height, fx, fy, cx, cy, ...)."""
        return self._recording.camera

    @property
    def frames(self) -> Iterator[ImageFrame]:
        """Runs on a thread of its own. Ends with the camera, or is closed when the run is told to stop."""
        try:
            for frame in self._recording.frames:
                time.sleep(
                    1 / self._recording.calibration.fps / self._speed
                )  # a driver's call would block here
                rgb, depth = frame.load()  # (H, W, 3) uint8 RGB; (H, W) uint16 raw or float32 metres
                yield ImageFrame(frame.timestamp, rgb, depth)
        finally:
            print("the camera is let go")


def main(folder: str, results: str, speed: float = 1.0) -> None:
    """Maps what the camera sees."""
    result = vsgraphs.run(LiveCamera(folder, speed), out=results)
    dropped = result.statuses.get("dropped", 0)
    print(f"{len(result.trajectory)} frames tracked, {dropped} came meanwhile and were dropped")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], *map(float, sys.argv[3:4]))
