"""Loads frames ahead of their use, in threads, in order, and never more than a few."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from vsgraphs.errors import RunError, StalledError
from vsgraphs.sources.following import with_following
from vsgraphs.sources.loaded import LoadedFrame, load
from vsgraphs.sources.source import Frame

DEFAULT_LIMIT_S = 10.0
# So many frames may be left behind, each with the thread that reads it, before there is no point in going on.
MOST_STUCK = 3
# A frame is waited for in slices: a program that was suspended meanwhile has not waited that long.
_SLICE_S = 0.1
# At the end, how long the threads may take over the image they are at.
_PATIENCE_S = 0.5


@dataclass(eq=False)
class _Worker:
    """A thread that loads. index: of the frame it is at."""

    index: int = -1
    thread: threading.Thread | None = None


class Prefetcher:
    """Iterates over frames in order while `workers` threads load up to `ahead` frames in advance.

    A frame that cannot be read comes as a LoadedFrame with `error`; any other exception is raised at its
    frame's turn. A frame whose images are waited for longer than `limit_s` seconds comes with a StalledError;
    the thread that reads it is left behind, and when more than MOST_STUCK threads are, RunError is raised.
    The next frame itself is waited for as long as the source takes. Leaving the context stops the threads. At
    most ahead + 1 frames are held at once.
    """

    def __init__(
        self, frames: Iterable[Frame], ahead: int = 6, workers: int = 1, limit_s: float = DEFAULT_LIMIT_S
    ) -> None:
        if ahead < 1 or workers < 1:
            raise ValueError("ahead and workers must be at least 1")
        self._pairs = with_following(frames)
        self._pulling = threading.Lock()  # one at a time asks the source; taken before the next one
        self._ahead, self._limit_s = ahead, limit_s
        self._changed = threading.Condition()  # guards all below
        self._loaded: dict[int, LoadedFrame | Exception] = {}
        self._at: dict[int, Frame] = {}  # begun, and not taken
        self._begun = self._taken = 0  # frames
        self._count: int | None = None  # of all frames, once the source has ended
        self._stopped = False
        self._workers: list[_Worker] = []  # without those left behind
        self._stuck = 0  # left behind, and not come back since
        for _ in range(workers):
            self._start_worker()

    def __enter__(self) -> Prefetcher:
        return self

    def __exit__(self, *exc: object) -> None:
        self.close()

    def __iter__(self) -> Iterator[LoadedFrame]:
        while (frame := self._take(self._taken)) is not None:
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
        if self._pulling.acquire(blocking=False):  # else a thread is stuck within the source
            self._pairs.close()
            self._pulling.release()

    def _take(self, index: int) -> LoadedFrame | None:
        """The frame, once it is loaded; None after the last one and after `stop`."""
        waited_s = 0.0
        with self._changed:
            while not (index in self._loaded or self._stopped or self._count == index):
                if waited_s >= self._limit_s:
                    break
                began, loading = time.monotonic(), index in self._at
                self._changed.wait(min(_SLICE_S, self._limit_s - waited_s))
                waited_s += min(time.monotonic() - began, _SLICE_S) if loading else 0.0
            if self._stopped or self._count == index:
                return None
            self._taken += 1
            self._changed.notify_all()
            frame = self._loaded.pop(index) if index in self._loaded else self._leave_behind(index)
            self._at.pop(index, None)
        if isinstance(frame, Exception):
            raise frame
        return frame

    def _leave_behind(self, index: int) -> LoadedFrame | Exception:
        """Gives up a frame, and the thread that is at it."""
        going_on = [worker for worker in self._workers if worker.index != index]
        self._stuck += len(self._workers) - len(going_on)
        self._workers = going_on
        frame = self._at[index]
        if self._stuck > MOST_STUCK:
            return RunError(
                f"{_named(frame)}: no answer within {self._limit_s:g} s, as for {MOST_STUCK} "
                f"frames before that are still waited for; the disk stalls, so the run ends at frame {index}"
            )
        self._start_worker()
        error = StalledError(f"{_named(frame)}: no answer within {self._limit_s:g} s")
        now = time.monotonic()
        return LoadedFrame(index, frame.timestamp, None, None, error, now - self._limit_s, now)

    def _start_worker(self) -> None:
        worker = _Worker()
        # A daemon: the program can end although it is stuck.
        worker.thread = threading.Thread(target=self._work, args=(worker,), name="decode", daemon=True)
        self._workers.append(worker)
        worker.thread.start()

    def _work(self, worker: _Worker) -> None:
        while (pulled := self._pull(worker)) is not None:
            frame = _load(worker.index, *pulled)
            with self._changed:
                if worker not in self._workers:
                    self._stuck -= 1
                    return
                self._loaded[worker.index] = frame
                worker.index = -1
                self._changed.notify_all()

    def _pull(self, worker: _Worker) -> tuple[Frame, float | None] | None:
        """The next frame to load, and when the one after it was taken; None when there is no more to do."""
        with self._pulling:
            with self._changed:
                self._changed.wait_for(self._may_go_on)
                if self._stopped or self._count is not None:
                    return None
            pulled: tuple[Frame, float | None] | Exception | None
            try:
                pulled = next(self._pairs, None)
            except Exception as error:  # the source's; raised at this frame's turn
                pulled = error
            with self._changed:
                self._changed.notify_all()
                if not isinstance(pulled, tuple):
                    if pulled is not None:
                        self._loaded[self._begun] = pulled
                    self._count = self._begun + (pulled is not None)
                    return None
                worker.index = self._begun
                self._at[worker.index] = pulled[0]
                self._begun += 1
                return pulled

    def _may_go_on(self) -> bool:
        return self._stopped or self._count is not None or self._begun < self._taken + self._ahead


def _load(index: int, frame: Frame, following: float | None) -> LoadedFrame | Exception:
    try:
        return load(index, frame, following)
    except Exception as error:  # raised at the frame's turn
        return error


def _named(frame: Frame) -> str:
    files = getattr(frame, "files", ())
    return " or ".join(str(path) for path in files) or f"the frame at {frame.timestamp:.6f} s"
