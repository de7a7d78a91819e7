"""Loads frames ahead of their use, in threads, in order, and never more than a few."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass

from vsgraphs.datasets.sequence import Depth, FrameRef, Rgb
from vsgraphs.errors import FrameError


@dataclass(frozen=True)
class LoadedFrame:
    """A frame with its images, or with the error that kept them from being read.

    begin_s, end_s: when loading began and ended, on the clock of time.monotonic (for the timeline).
    """

    index: int
    timestamp: float
    rgb: Rgb | None
    depth: Depth | None
    error: FrameError | None
    begin_s: float
    end_s: float


class Prefetcher:
    """Iterates over frames in order while `workers` threads load up to `ahead` frames in advance.

    A frame that cannot be read comes as a LoadedFrame with `error`; any other exception is raised at its
    frame's turn. Leaving the context stops the threads. At most ahead + 1 frames are held at once.
    """

    def __init__(self, frames: Sequence[FrameRef], ahead: int = 6, workers: int = 1) -> None:
        if ahead < 1 or workers < 1:
            raise ValueError("ahead and workers must be at least 1")
        self._frames = frames
        self._ahead = ahead
        self._stop = threading.Event()
        self._pool = ThreadPoolExecutor(workers, thread_name_prefix="decode")
        self._pending: deque[Future[LoadedFrame]] = deque()
        self._next = 0
        self._fill()

    def __enter__(self) -> Prefetcher:
        return self

    def __exit__(self, *exc: object) -> None:
        self.close()

    def __iter__(self) -> Iterator[LoadedFrame]:
        while self._pending:
            frame = self._pending.popleft().result()
            self._fill()
            yield frame

    def close(self) -> None:
        """Stops loading and waits for the threads; frames loaded in vain are dropped."""
        self._stop.set()
        self._pending.clear()
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _fill(self) -> None:
        while len(self._pending) < self._ahead and self._next < len(self._frames) and not self._stop.is_set():
            self._pending.append(self._pool.submit(_load, self._next, self._frames[self._next]))
            self._next += 1


def _load(index: int, frame: FrameRef) -> LoadedFrame:
    begin = time.monotonic()
    try:
        rgb, depth = frame.load()
    except FrameError as error:
        return LoadedFrame(index, frame.timestamp, None, None, error, begin, time.monotonic())
    return LoadedFrame(index, frame.timestamp, rgb, depth, None, begin, time.monotonic())
