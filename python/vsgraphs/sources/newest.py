"""Frames of a camera that does not wait: the newest one each time."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Iterator

from vsgraphs.sources.loaded import LoadedFrame, load
from vsgraphs.sources.source import Frame

_SLICE_S = 0.1
# At the end, how long the source may take to come back with a frame.
_PATIENCE_S = 0.5


class Newest:
    """Iterates over a live source's frames: waits for one, and hands out the newest that has come since.

    Those in between come first, as dropped ones, never loaded. A thread of its own takes frames from the
    source; the newest is loaded on the thread that iterates. What the source raises is raised at its turn.
    stopped: asked while there is no frame, on the thread that iterates; True ends the iteration.
    """

    def __init__(self, frames: Iterable[Frame], stopped: Callable[[], bool] = lambda: False) -> None:
        self._frames, self._asked = frames, stopped
        self._changed = threading.Condition()  # guards all below
        self._come = 0  # frames
        self._newest: Frame | None = None
        self._missed: list[float] = []  # timestamps of frames before it that nobody has taken
        self._ended = self._stopped = False
        self._trouble: Exception | None = None
        # A daemon: the program can end although a camera does not answer.
        self._thread = threading.Thread(target=self._take, name="camera", daemon=True)
        self._thread.start()

    def __enter__(self) -> Newest:
        return self

    def __exit__(self, *exc: object) -> None:
        self.close()

    def __iter__(self) -> Iterator[LoadedFrame]:
        while not self._asked():
            with self._changed:
                while self._newest is None and not (self._stopped or self._ended):
                    self._changed.wait(_SLICE_S)
                    self._stopped = self._stopped or self._asked()
                frame, self._newest = self._newest, None
                missed, self._missed = self._missed, []
                last = self._come - 1
            if frame is None or self._stopped:
                break
            now = time.monotonic()
            for number, timestamp in enumerate(missed, last - len(missed)):
                yield LoadedFrame(number, timestamp, None, None, None, now, now, dropped=True)
            yield load(last, frame)
        if self._trouble is not None and not self._stopped:
            raise self._trouble

    def stop(self) -> None:
        """Ends the iteration, also one that waits for a frame. Any thread."""
        with self._changed:
            self._stopped = True
            self._changed.notify_all()

    def close(self) -> None:
        """Stops; a source that does not come back from its camera is left behind."""
        self.stop()
        self._thread.join(_PATIENCE_S)

    def _take(self) -> None:
        trouble: Exception | None = None
        try:
            for frame in self._frames:
                with self._changed:
                    if self._stopped:
                        break
                    if self._newest is not None:
                        self._missed.append(self._newest.timestamp)
                    self._newest = frame
                    self._come += 1
                    self._changed.notify_all()
        except Exception as error:  # raised where the frames are iterated
            trouble = error
        close = getattr(self._frames, "close", None)
        if close is not None:
            close()
        with self._changed:
            self._trouble, self._ended = trouble, True
            self._changed.notify_all()
