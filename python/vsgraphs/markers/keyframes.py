"""Looks for markers on keyframes, beside tracking."""

from __future__ import annotations

import statistics
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from vsgraphs.keyframe_queue import KeyframeQueue
from vsgraphs.markers.detector import Detections
from vsgraphs.trajectory import Array

# Keyframes that wait for the detector; beyond it, the oldest goes. 12 MB at 640x480.
WAITING = 8


@dataclass(frozen=True)
class _Keyframe:
    frame_index: int
    rgb: Array
    depth: Array


class KeyframeMarkers:
    """A `Slam` that is told of the markers in its keyframes: give frames to its `track` instead.

    detector: (rgb, depth) -> Detections. beside=True: on a thread of its own, in order; when more than
    `waiting` keyframes wait, the oldest is dropped and counted. beside=False: within `track`, before it
    returns, so that runs are alike. An error of the detector is raised by `track` or `finish` as
    RuntimeError. Memory: `waiting` colour and depth images.
    """

    def __init__(
        self,
        slam: Any,
        detector: Callable[[Array, Array], Detections],
        *,
        beside: bool = True,
        waiting: int = WAITING,
    ) -> None:
        self._slam, self._detector = slam, detector
        self.warnings: list[str] = []
        self.spans: list[tuple[int, int, int]] = []  # begin us (monotonic clock), duration us, frame
        self._counts: Counter[str] = Counter()
        self._unsure: Counter[int] = Counter()
        self._placed: Counter[int] = Counter()
        self._scales: dict[int, list[float]] = {}
        self._beside = beside
        self._queue = KeyframeQueue(self._try, "markers", beside=beside, waiting=waiting)

    def track(self, rgb: Array, depth: Array, timestamp: float) -> Any:
        """`slam.track`; a keyframe's images are copied and searched. Raises what `slam.track` raises."""
        self._raise_failure()
        result = self._slam.track(rgb, depth, timestamp)
        if result.is_keyframe:
            images = (rgb.copy(), depth.copy()) if self._beside else (rgb, depth)
            self._queue.put(_Keyframe(result.index, *images))
        return result

    def add_segmentation(self, *args: Any) -> None:
        """`slam.add_segmentation`: a segmenter may stand above."""
        self._slam.add_segmentation(*args)

    def finish(self, limit_s: float = 10.0) -> None:
        """Searches what waits, for at most `limit_s`, and drops the rest; call it before `slam.finish`."""
        self._queue.finish(limit_s)
        self._note()
        self._raise_failure()

    def report(self) -> dict[str, Any]:
        """Counts of keyframes and sights, and the median time of a search; complete after `finish`."""
        counts = {key: self._counts[key] for key in ("searched", "sights", "unsure")}
        times = [duration for _, duration, _ in self.spans]
        return {
            **counts,
            "dropped": self._queue.dropped,
            "median_ms": statistics.median(times) / 1e3 if times else None,
        }

    def _try(self, keyframe: _Keyframe) -> None:
        try:
            self._search(keyframe)
        except Exception as error:  # never to be taken for a frame that is refused
            raise RuntimeError(f"markers: {error}") from error

    def _search(self, keyframe: _Keyframe) -> None:
        began = time.monotonic()
        found = self._detector(keyframe.rgb, keyframe.depth)
        duration_us = int((time.monotonic() - began) * 1e6)
        self.spans.append((int(began * 1e6), duration_us, keyframe.frame_index))
        self._counts["searched"] += 1
        self._counts["sights"] += len(found.ids)
        self._counts["unsure"] += len(found.unsure)
        self._placed.update(int(number) for number in found.ids)
        for number, scale in found.scales:
            self._scales.setdefault(number, []).append(scale)
        if len(found.ids):
            arrays = found.ids, found.size_m, found.camera_from_marker, found.covariance
            self._slam.add_markers(keyframe.frame_index, *arrays)

    def _raise_failure(self) -> None:
        if (failure := self._queue.take_failure()) is not None:
            raise failure

    def _note(self) -> None:
        if dropped := self._queue.dropped:
            self.warnings.append(f"markers: {dropped} keyframes were not searched, they came too fast")
        for number, scales in sorted(self._scales.items()):
            if len(scales) > self._placed[number]:
                self.warnings.append(
                    f"markers: by its depth marker {number} is {np.median(scales):.2f} times as large as "
                    f"size_m says ({len(scales)} sights left out); measure its black square"
                )
