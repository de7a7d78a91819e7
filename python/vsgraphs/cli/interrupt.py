"""Ctrl-C ends the loop, not the program: what was computed is kept."""

from __future__ import annotations

import signal
from types import FrameType, TracebackType

from vsgraphs.cli.failures import EXIT_INTERRUPTED


class Interrupt:
    """While entered, the first SIGINT or SIGTERM only sets a flag; the second acts as usual.

    `exit_code` is the shell's for the signal that came (130, 143), 0 if none came.
    """

    def __init__(self) -> None:
        self.signal: int | None = None
        self._before: dict[int, object] = {}

    def __enter__(self) -> Interrupt:
        for number in (signal.SIGINT, signal.SIGTERM):
            self._before[number] = signal.signal(number, self._arrived)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._restore()

    def requested(self) -> bool:
        """Whether a signal has come."""
        return self.signal is not None

    @property
    def exit_code(self) -> int:
        """0 if no signal has come, else 128 + its number."""
        return 0 if self.signal is None else EXIT_INTERRUPTED - signal.SIGINT + self.signal

    def _arrived(self, number: int, frame: FrameType | None) -> None:  # noqa: ARG002
        self.signal = number
        self._restore()

    def _restore(self) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)  # type: ignore[arg-type]  # what signal.signal itself returned
        self._before = {}
