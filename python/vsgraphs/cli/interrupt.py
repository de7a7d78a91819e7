"""Ctrl-C ends the loop, not the program: what was computed is kept. No signal ever shows a trace.

SIGTERM, and SIGHUP (the terminal is gone, as when ssh drops), are taken like Ctrl-C.
"""

from __future__ import annotations

import contextlib
import os
import select
import signal
import sys
import threading
import time
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any

EXIT_SIGNAL = 128  # plus the signal's number: what shells show
_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
# A program that started this one may pass on the signal that the terminal sent to both.
_SAME_S = 0.1
# How long what stays of unfinished files may take to remove: the disk may be what does not answer.
_TIDYING_S = 0.3
# The end of a pipe that the system writes signals to. A forked child must not write its own there.
_listening: set[int] = set()
os.register_at_fork(after_in_child=lambda: signal.set_wakeup_fd(-1) if _listening else None)


def leave_at_once() -> None:
    """From now on each of the signals ends the process, with one line: there is nothing to keep yet."""
    for number in _heeded():
        signal.signal(number, _leave)


def let_die() -> None:
    """From now on the signals kill the process as the system does: when all is done and told.

    But for SIGHUP: it comes more than once, and would then change the exit code.
    """
    for number in _heeded():
        signal.signal(number, signal.SIG_IGN if number == signal.SIGHUP else signal.SIG_DFL)


class Interrupt:
    """While entered, the first signal only sets a flag; Ctrl-C after it (or SIGTERM twice) ends the process.

    Signals are heard on a thread of their own, so at once, whatever the main thread is busy with. `exit_code`
    is the shell's for the signal that came (130, 143, 129), 0 if none came. When the process is about to end
    what last_words returns is said, and tidy is called, but not waited for if it takes long.
    """

    def __init__(
        self,
        last_words: Callable[[], str] = lambda: "interrupted",
        tidy: Callable[[], object] = lambda: None,
    ) -> None:
        self.signal: int | None = None
        self._last_words, self._tidy = last_words, tidy
        self._at_first: list[Callable[[], object]] = []
        self._came_at = 0.0
        self._before: dict[int, Any] = {}

    def __enter__(self) -> Interrupt:
        self._reader, self._writer = os.pipe()
        os.set_blocking(self._writer, False)
        self._thread = threading.Thread(target=self._listen, name="signals", daemon=True)
        self._thread.start()
        _listening.add(self._writer)
        self._wakeup_before = signal.set_wakeup_fd(self._writer, warn_on_full_buffer=False)
        for number in _heeded():
            self._before[number] = signal.signal(number, _only_heard)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)
        signal.set_wakeup_fd(self._wakeup_before)
        _listening.discard(self._writer)
        os.write(self._writer, b"\0")
        self._thread.join()
        os.close(self._writer)
        os.close(self._reader)

    def at_first(self, *calls: Callable[[], object]) -> None:
        """Has them called when the first signal comes, on another thread. They must not wait for long."""
        self._at_first += calls
        if self.requested():  # it came before there was anybody to call
            for call in calls:
                call()

    def requested(self) -> bool:
        """Whether a signal has come."""
        return self.signal is not None

    @property
    def exit_code(self) -> int:
        """0 if no signal has come, else 128 + its number."""
        return 0 if self.signal is None else EXIT_SIGNAL + self.signal

    def _listen(self) -> None:
        while True:
            for number in os.read(self._reader, 64):
                if number == 0:
                    return
                if number in _SIGNALS:
                    self._heard(number)

    def _heard(self, number: int) -> None:
        now = time.monotonic()
        if self.signal is None:
            self.signal, self._came_at = number, now
            for call in self._at_first:
                with contextlib.suppress(Exception):  # the others are called all the same
                    call()
        elif self._is_second(number) and now - self._came_at > _SAME_S:
            words = "interrupted"
            with contextlib.suppress(Exception):
                words = self._last_words()
            _end_process(number, words, self._tidy)

    def _is_second(self, number: int) -> bool:
        # Whoever hangs up or shuts down says so in several ways: no sign of impatience.
        return number == signal.SIGINT or (number == signal.SIGTERM and self.signal != signal.SIGHUP)


def _heeded() -> list[int]:
    """The signals, without SIGHUP where it was ignored when the program started (nohup)."""
    return [n for n in _SIGNALS if n != signal.SIGHUP or signal.getsignal(n) is not signal.SIG_IGN]


def _only_heard(number: int, frame: FrameType | None) -> None:
    """A handler of Python's must be there for the thread to be told."""


def _leave(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
    _end_process(number, "interrupted")


def _end_process(number: int, words: str, tidy: Callable[[], object] = lambda: None) -> None:
    """No handlers, no threads, no destructors: nothing that could wait or fail."""
    _say(words)

    def tidy_all() -> None:
        for name, remove in (("atomic", "remove_unfinished"), ("lock", "remove_lock_files")):
            module = sys.modules.get(f"vsgraphs.export.{name}")
            if module is not None:
                getattr(module, remove)()
        tidy()

    with contextlib.suppress(Exception):
        tidying = threading.Thread(target=tidy_all, daemon=True)
        tidying.start()
        tidying.join(_TIDYING_S)
    os._exit(EXIT_SIGNAL + number)


def _say(words: str) -> None:
    """On standard error unless that would have to be waited for (a terminal that is held, a full pipe)."""
    with contextlib.suppress(Exception):
        descriptor = sys.stderr.fileno()
        if select.select([], [descriptor], [], 0.0)[1]:
            clear = "\r\x1b[K" if os.isatty(descriptor) else ""
            os.write(descriptor, f"{clear}{words}\n".encode()[: select.PIPE_BUF])
