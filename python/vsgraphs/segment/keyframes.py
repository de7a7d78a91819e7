"""Runs a segmenter on keyframes, beside tracking."""

from __future__ import annotations

import statistics
import threading
import time
from collections import Counter, deque
from collections.abc import Callable
from dataclasses import dataclass
from types import TracebackType
from typing import Any

import numpy as np

from vsgraphs.errors import FrameError, InputError
from vsgraphs.keyframe_queue import KeyframeQueue
from vsgraphs.segment.segmentation import (
    RecordedSegmentations,
    Rgb,
    Segmentation,
    Segmenter,
    checked,
    name_of,
)

# Keyframes that wait for the network; beyond it, the oldest goes. 7 MB at 640x480.
WAITING = 8
# At the end of a run, how long what waits may take.
DRAIN_LIMIT_S = 10.0
_NAMED_FRAMES = 5


@dataclass(frozen=True)
class _Keyframe:
    frame_index: int
    rgb: Rgb
    timestamp_s: float


class KeyframeSegmentation:
    """A `Slam` whose keyframes are segmented: give frames to its `track` instead of the Slam's.

    beside=True: on a thread of its own, newest keyframe first; when more than `waiting` of them wait, the
    oldest is dropped and counted. beside=False: within `track`, before it returns, so that runs are alike.

    A segmenter that raises is told once and not called again; the map goes on by geometry. A FrameError
    concerns its frame alone. `tell` is called with such lines, within `track` or `finish`.

    Memory: `waiting` images.
    """

    def __init__(
        self,
        slam: Any,
        segmenter: Segmenter | RecordedSegmentations,
        *,
        beside: bool = True,
        waiting: int = WAITING,
        tell: Callable[[str], None] = lambda _: None,
    ) -> None:
        self._slam = slam
        self._segmenter = segmenter
        self._tell = tell
        self.name = name_of(segmenter)
        self.warnings: list[str] = []
        self.spans: list[tuple[int, int, int]] = []  # begin us (monotonic clock), duration us, frame
        self._counts: Counter[str] = Counter()
        self._untold: deque[str] = deque()
        self._broken = self._ended = False
        self._lock = threading.Lock()  # guards spans, counts and untold
        self._queue = KeyframeQueue(
            self._work, "segmentation", beside=beside, waiting=waiting, newest_first=True
        )

    def __enter__(self) -> KeyframeSegmentation:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.finish(DRAIN_LIMIT_S if kind is None else 0.0)

    def track(self, rgb: Rgb, depth: Any, timestamp: float) -> Any:
        """`slam.track`; a keyframe's image is copied and segmented (a grey one as RGB). Raises what
        `slam.track` raises.
        """
        result = self._slam.track(rgb, depth, timestamp)
        if result.is_keyframe:
            image = np.repeat(rgb[:, :, None], 3, axis=2) if rgb.ndim == 2 else rgb.copy()
            keyframe = _Keyframe(result.index, image, timestamp)
            if self._broken:
                self._count("failed")
            else:
                self._queue.put(keyframe)
        self._pass_on()
        return result

    @property
    def waiting(self) -> int:
        """Keyframes that wait or are being segmented."""
        return self._queue.waiting

    def finish(self, limit_s: float = DRAIN_LIMIT_S) -> None:
        """Segments what waits, for at most `limit_s`, and drops the rest; call it before `slam.finish`.

        A call of the segmenter that is under way is waited for as long again, at least 1 s, then left
        behind: its result is no longer handed over. Raises RuntimeError if the core refused a result.
        """
        self._queue.finish(limit_s, patience_s=max(limit_s, 1.0))
        if not self._ended:
            self._ended = True
            self._warn_of_losses()
        self._pass_on()
        if (refusal := self._queue.take_failure()) is not None:
            raise refusal

    def report(self) -> dict[str, Any]:
        """Counts of keyframes and the median time of a segmentation; complete after `finish`."""
        with self._lock:
            counts = {key: self._counts[key] for key in ("segmented", "failed", "missing")}
            counts["dropped"] = self._queue.dropped
            times = [duration for _, duration, _ in self.spans]
            return {**counts, "median_ms": statistics.median(times) / 1e3 if times else None}

    def _warn_of_losses(self) -> None:
        if self._queue.left_behind:
            self._warn(f"segmentation: {self.name} did not come back from its last call, left behind")
        if dropped := self._queue.dropped:
            self._warn(f"segmentation: {dropped} keyframes dropped, {self.name} is slower than they come")

    def _work(self, keyframe: _Keyframe) -> None:
        try:
            self._segment(keyframe)
        except Exception:  # the core's refusal
            self._broken = True
            self._count("failed", self._queue.discard())
            raise

    def _segment(self, keyframe: _Keyframe) -> None:
        if self._broken:
            self._count("failed")
            return
        began = time.monotonic()
        try:
            found = self._call(keyframe)
        except FrameError as error:
            self._note_frame(str(error))
            return
        except Exception as error:  # whatever a user's own segmenter raises must not end the run
            self._give_up(error)
            return
        ended = time.monotonic()
        if self._queue.left_behind:
            return
        if found is None:
            self._count("missing")
            return
        with self._lock:
            self.spans.append((int(began * 1e6), int((ended - began) * 1e6), keyframe.frame_index))
        if self._hand_over(keyframe.frame_index, found):
            self._count("segmented")

    def _call(self, keyframe: _Keyframe) -> Segmentation | None:
        if isinstance(self._segmenter, RecordedSegmentations):
            found = self._segmenter.at(keyframe.timestamp_s)
        else:
            found = self._segmenter(keyframe.rgb)
        return None if found is None else checked(found, self.name)

    def _hand_over(self, frame_index: int, found: Segmentation) -> bool:
        try:
            self._slam.add_segmentation(
                frame_index, found.roles, found.confidence, found.instances, found.classes, found.class_names
            )
        except ValueError as error:
            if found.classes is not None and isinstance(error, InputError):
                self._give_up(error)  # a name whose number another one has: only the core knows all names
                return False
            # It was checked: a defect, and not to be taken for a frame that is refused.
            raise RuntimeError(
                f"the core refused the segmentation of frame {frame_index}: {error}"
            ) from error
        return True

    def _note_frame(self, line: str) -> None:
        with self._lock:
            self._counts["failed"] += 1
            if self._counts["failed"] <= _NAMED_FRAMES:
                self._untold.append(f"segmentation: {line}")

    def _give_up(self, error: Exception) -> None:
        text = " ".join(str(error).split()) or "no message"
        reason = text if self.name in text else f"{self.name}: {type(error).__name__}: {text}"
        self._broken = True
        self._count("failed", 1 + self._queue.discard())
        with self._lock:
            self._untold.append(f"segmentation failed, geometry alone from here on: {reason}")

    def _count(self, what: str, number: int = 1) -> None:
        with self._lock:
            self._counts[what] += number

    def _warn(self, line: str) -> None:
        with self._lock:
            self._untold.append(line)
        self._pass_on()

    def _pass_on(self) -> None:
        """On the caller's thread: listeners need not be safe to call from two."""
        while self._untold:
            line = self._untold.popleft()
            self.warnings.append(line)
            self._tell(line)


def attach(
    slam: Any, segmenter: Segmenter | RecordedSegmentations, *, beside: bool = True, waiting: int = WAITING
) -> KeyframeSegmentation:
    """A stand-in for `slam` whose keyframes are segmented.

    with attach(slam, my_function) as tracked:
        for rgb, depth, timestamp in frames:
            tracked.track(rgb, depth, timestamp)
    slam.finish()
    """
    return KeyframeSegmentation(slam, segmenter, beside=beside, waiting=waiting)
