"""Recorded frames at the pace of their timestamps, as a live camera would deliver them."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

from vsgraphs.sources.loaded import LoadedFrame


class Realtime:
    """A live camera that keeps only its newest frame.

    A frame is there when as much time has passed since the first frame as their timestamps say. It is
    dropped if by the time it is asked for the following frame is there as well.
    """

    def __init__(
        self,
        stop: Callable[[], bool],
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self._stop = stop
        self._clock = clock
        self._sleep = sleep
        self._offset: float | None = None  # clock - timestamp

    def paced(self, frames: Iterable[LoadedFrame]) -> Iterator[LoadedFrame]:
        """The frames, each at its time; those that come too late are marked as dropped."""
        for frame in frames:
            admitted = self.admit(frame.timestamp, frame.following)
            yield frame if admitted else replace(frame, dropped=True)

    def admit(self, timestamp: float, following: float | None) -> bool:
        """Waits for the frame's time; False when it is already past the following frame's."""
        now = self._clock()
        if self._offset is None:
            self._offset = now - timestamp
        if following is not None and now >= following + self._offset:
            return False
        due = timestamp + self._offset
        while now < due and not self._stop():
            self._sleep(min(due - now, 0.1))  # in slices, so that Ctrl-C in a gap is answered
            now = self._clock()
        return True
