"""One line that shows how a run goes. Written by hand: it costs a few microseconds and no import."""

from __future__ import annotations

import sys
import time
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from vsgraphs.run.session import Tally

_BAR = 24
_ON_TERMINAL_S = 0.1
_ELSEWHERE_S = 5.0
_SPEED_WINDOW_S = 2.0


class Progress:
    """A bar on a terminal, a line every five seconds elsewhere: frames, speed, state, time left."""

    def __init__(
        self, total: int | None, stream: TextIO | None = None, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._total = total
        self._stream = stream or sys.stderr
        self._clock = clock
        self._terminal = self._stream.isatty()
        self._interval = _ON_TERMINAL_S if self._terminal else _ELSEWHERE_S
        self._begin = self._last = clock()
        self._recent: deque[tuple[float, int]] = deque([(self._begin, 0)])
        self._drawn = False

    def frame(self, tally: Tally, status: str) -> None:
        """Draws anew if it is time."""
        now = self._clock()
        if now - self._last < self._interval:
            return
        self._last = now
        self._recent.append((now, tally.seen))
        while len(self._recent) > 2 and now - self._recent[0][0] > max(_SPEED_WINDOW_S, self._interval):
            self._recent.popleft()
        then, seen = self._recent[0]
        speed = (tally.seen - seen) / (now - then) if now > then else 0.0
        self._draw(self._text(tally, status, speed))

    def event(self, line: str) -> None:
        """A line of its own, above the bar."""
        self.clear()
        self._write(f"{line}\n")

    def doing(self, what: str) -> None:
        """What goes on once there are no more frames: on a terminal, in place of the bar."""
        if self._terminal:
            self._draw(f"{what} ...")

    def clear(self) -> None:
        """Takes the bar away."""
        if self._drawn:
            self._write("\r\x1b[K")
            self._drawn = False

    def _text(self, tally: Tally, status: str, speed: float) -> str:
        if self._total is None:
            return f"{tally.seen} frames  {speed:.0f} frames/s  {status}".rstrip()
        share = tally.seen / self._total if self._total else 1.0
        left = f"{_duration((self._total - tally.seen) / speed)} left" if speed > 0 else ""
        text = f"{tally.seen}/{self._total} frames  {speed:.0f} frames/s  {status}  {left}".rstrip()
        if not self._terminal:
            return text
        full = int(share * _BAR)
        return f"[{'#' * full}{'.' * (_BAR - full)}] {text}"

    def _draw(self, text: str) -> None:
        if self._terminal:
            self._write(f"\r\x1b[K{text}")
            self._drawn = True
        else:
            self._write(f"{text}\n")

    def _write(self, text: str) -> None:
        try:
            self._stream.write(text)
            self._stream.flush()
        except (OSError, ValueError):  # a closed terminal must not end a run
            self._stream = _Nowhere()


class _Nowhere:
    def write(self, text: str) -> int:
        return len(text)

    def flush(self) -> None:
        pass


def _duration(seconds: float) -> str:
    whole = round(seconds)
    return f"{whole // 60}:{whole % 60:02d} min" if whole >= 60 else f"{whole} s"
