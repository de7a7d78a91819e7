"""Looks for markers on keyframes, beside tracking."""

from __future__ import annotations

import statistics
import threading
import time
from collections import Counter, deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

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
        if waiting < 1:
            raise ValueError("waiting must be at least 1")
        self._slam, self._detector, self._most = slam, detector, waiting
        self.warnings: list[str] = []
        self.spans: list[tuple[int, int, int]] = []  # begin us (monotonic clock), duration us, frame
        self._counts: Counter[str] = Counter()
        self._unsure: Counter[int] = Counter()
        self._placed: Counter[int] = Counter()
        self._scales: dict[int, list[float]] = {}
        self._queue: deque[_Keyframe] = deque()
        self._changed = threading.Condition()  # guards the queue and the two below
        self._busy = self._stopping = False
        self._failure: Exception | None = None
        self._thread = threading.Thread(target=self._work, name="markers", daemon=True) if beside else None
        if self._thread is not None:
            self._thread.start()

    def track(self, rgb: Array, depth: Array, timestamp: float) -> Any:
        """`slam.track`; a keyframe's images are copied and searched. Raises what `slam.track` raises."""
        self._raise_failure()
        result = self._slam.track(rgb, depth, timestamp)
        if result.is_keyframe:
            if self._thread is None:
                self._try(_Keyframe(result.index, rgb, depth))
                self._raise_failure()
            else:
                self._enqueue(_Keyframe(result.index, rgb.copy(), depth.copy()))
        return result

    def add_segmentation(self, *args: Any) -> None:
        """`slam.add_segmentation`: a segmenter may stand above."""
        self._slam.add_segmentation(*args)

    def finish(self, limit_s: float = 10.0) -> None:
        """Searches what waits, for at most `limit_s`, and drops the rest; call it before `slam.finish`."""
        thread, self._thread = self._thread, None
        if thread is not None:
            with self._changed:
                self._changed.wait_for(lambda: not (self._queue or self._busy) or self._failure, limit_s)
                self._counts["dropped"] += len(self._queue)
                self._queue.clear()
                self._stopping = True
                self._changed.notify_all()
            thread.join()
        self._note()
        self._raise_failure()

    def report(self) -> dict[str, Any]:
        """Counts of keyframes and sights, and the median time of a search; complete after `finish`."""
        counts = {key: self._counts[key] for key in ("searched", "dropped", "sights", "unsure")}
        times = [duration for _, duration, _ in self.spans]
        return {**counts, "median_ms": statistics.median(times) / 1e3 if times else None}

    def _enqueue(self, keyframe: _Keyframe) -> None:
        with self._changed:
            self._queue.append(keyframe)
            if len(self._queue) > self._most:
                self._queue.popleft()
                self._counts["dropped"] += 1
            self._changed.notify_all()

    def _work(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._queue or self._stopping)
                if not self._queue:
                    return
                keyframe = self._queue.popleft()
                self._busy = True
            self._try(keyframe)
            with self._changed:
                self._busy = False
                self._changed.notify_all()
                if self._failure is not None:
                    return

    def _try(self, keyframe: _Keyframe) -> None:
        try:
            self._search(keyframe)
        except Exception as error:  # told on the caller's thread, never as a refused frame
            self._failure = RuntimeError(f"markers: {error}")
            self._failure.__cause__ = error

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
        if self._failure is not None:
            failure, self._failure = self._failure, None
            raise failure

    def _note(self) -> None:
        if self._counts["dropped"]:
            self.warnings.append(
                f"markers: {self._counts['dropped']} keyframes were not searched, they came too fast"
            )
        for number, scales in sorted(self._scales.items()):
            if len(scales) > self._placed[number]:
                self.warnings.append(
                    f"markers: by its depth marker {number} is {np.median(scales):.2f} times as large as "
                    f"size_m says ({len(scales)} sights left out); measure its black square"
                )
