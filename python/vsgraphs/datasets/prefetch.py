"""Loads frames ahead of their use, in threads, in order, and never more than a few."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from vsgraphs.datasets.sequence import Depth, FrameRef, Rgb
from vsgraphs.errors import FrameError, RunError, StalledError

DEFAULT_LIMIT_S = 10.0
# So many frames may be left behind, each with the thread that reads it, before there is no point in going on.
MOST_STUCK = 3
# A frame is waited for in slices: a program that was suspended meanwhile has not waited that long.
_SLICE_S = 0.1
# At the end, how long the threads may take over the image they are at.
_PATIENCE_S = 0.5


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


@dataclass(eq=False)
class _Worker:
    """A thread that loads. index: of the frame it is at."""

    index: int = -1
    thread: threading.Thread | None = None


class Prefetcher:
    """Iterates over frames in order while `workers` threads load up to `ahead` frames in advance.

    A frame that cannot be read comes as a LoadedFrame with `error`; any other exception is raised at its
    frame's turn. A frame that is waited for longer than `limit_s` seconds comes with a StalledError; the
    thread that reads it is left behind, and when more than MOST_STUCK threads are, RunError is raised.
    Leaving the context stops the threads. At most ahead + 1 frames are held at once.
    """

    def __init__(
        self, frames: Sequence[FrameRef], ahead: int = 6, workers: int = 1, limit_s: float = DEFAULT_LIMIT_S
    ) -> None:
        if ahead < 1 or workers < 1:
            raise ValueError("ahead and workers must be at least 1")
        self._frames, self._ahead, self._limit_s = frames, ahead, limit_s
        self._changed = threading.Condition()  # guards all below
        self._loaded: dict[int, LoadedFrame | Exception] = {}
        self._begun = self._taken = 0  # frames
        self._stopped = False
        self._workers: list[_Worker] = []  # without those left behind
        self._stuck = 0  # left behind, and not come back since
        for _ in range(min(workers, len(frames))):
            self._start_worker()

    def __enter__(self) -> Prefetcher:
        return self

    def __exit__(self, *exc: object) -> None:
        self.close()

    def __iter__(self) -> Iterator[LoadedFrame]:
        while self._taken < len(self._frames):
            frame = self._take(self._taken)
            if frame is None:
                return
            yield frame

    def stop(self) -> None:
        """Ends the iteration, also one that waits for a frame. Any thread."""
        with self._changed:
            self._stopped = True
            self._changed.notify_all()

    def close(self) -> None:
        """Stops loading and the threads, but for those that are stuck; frames loaded in vain are dropped."""
        self.stop()
        deadline = time.monotonic() + _PATIENCE_S
        for worker in self._workers:
            if worker.thread is not None:
                worker.thread.join(max(0.0, deadline - time.monotonic()))
        with self._changed:
            self._loaded.clear()

    def _take(self, index: int) -> LoadedFrame | None:
        """The frame, once it is loaded; None after `stop`."""
        waited_s = 0.0
        with self._changed:
            while index not in self._loaded and not self._stopped and waited_s < self._limit_s:
                began = time.monotonic()
                self._changed.wait(min(_SLICE_S, self._limit_s - waited_s))
                waited_s += min(time.monotonic() - began, _SLICE_S)
            if self._stopped:
                return None
            self._taken += 1
            self._changed.notify_all()
            frame = self._loaded.pop(index) if index in self._loaded else self._leave_behind(index)
        if isinstance(frame, Exception):
            raise frame
        return frame

    def _leave_behind(self, index: int) -> LoadedFrame | Exception:
        """Gives up a frame, and the thread that is at it."""
        going_on = [worker for worker in self._workers if worker.index != index]
        self._stuck += len(self._workers) - len(going_on)
        self._workers = going_on
        if self._stuck > MOST_STUCK:
            return RunError(
                f"{_named(self._frames[index])}: no answer within {self._limit_s:g} s, as for {MOST_STUCK} "
                f"frames before that are still waited for; the disk stalls, so the run ends at frame {index}"
            )
        self._start_worker()
        frame = self._frames[index]
        error = StalledError(f"{_named(frame)}: no answer within {self._limit_s:g} s")
        now = time.monotonic()
        return LoadedFrame(index, frame.timestamp, None, None, error, now - self._limit_s, now)

    def _start_worker(self) -> None:
        worker = _Worker()
        # A daemon: the program can end although it is stuck.
        worker.thread = threading.Thread(target=self._work, args=(worker,), name="decode", daemon=True)
        self._workers.append(worker)
        worker.thread.start()

    def _may_begin(self) -> bool:
        return self._begun < min(len(self._frames), self._taken + self._ahead)

    def _work(self, worker: _Worker) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._stopped or self._may_begin())
                if self._stopped:
                    return
                worker.index = index = self._begun
                self._begun += 1
            frame = _load(index, self._frames[index])
            with self._changed:
                if worker not in self._workers:
                    self._stuck -= 1
                    return
                worker.index = -1
                self._loaded[index] = frame
                self._changed.notify_all()


def _load(index: int, frame: FrameRef) -> LoadedFrame | Exception:
    begin = time.monotonic()
    try:
        rgb, depth = frame.load()
    except FrameError as error:
        return LoadedFrame(index, frame.timestamp, None, None, error, begin, time.monotonic())
    except Exception as error:  # raised at the frame's turn
        return error
    return LoadedFrame(index, frame.timestamp, rgb, depth, None, begin, time.monotonic())


def _named(frame: FrameRef) -> str:
    return " or ".join(str(path) for path in frame.files)
