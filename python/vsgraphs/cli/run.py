"""`vsgraphs run`: `vsgraphs.run` with a terminal."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from vsgraphs.cli.interrupt import Interrupt
from vsgraphs.cli.progress import Progress
from vsgraphs.cli.terminal import that_may_go
from vsgraphs.cli.viewing import linger
from vsgraphs.run import RunRequest, measures
from vsgraphs.run.conduct import Run
from vsgraphs.run.listener import Listener
from vsgraphs.run.summary import summarise

if TYPE_CHECKING:
    from vsgraphs.run.session import Tally

_INTERRUPTED = (
    "interrupted: results so far are kept and written; Ctrl-C again skips those still to be written"
)


def run_sequence(request: RunRequest) -> int:
    """Runs and writes the results; returns the exit code. Raises InputError for what the user can cure."""
    with that_may_go():
        told = Terminal()
        run = Run(request, told, since_s=measures.process_start(), cpu_before_s=0.0)
        guard = _Signals(told)
        try:
            result = run.go(guard)
        finally:
            told.clear()
        if result.info.get("tracked"):
            print(summarise(result.info, result.folder), flush=True)
        if result.failure is not None:
            raise result.failure
        linger(run.view.sinks if run.view else None, result.folder)
        return guard.exit_code


class _Signals:
    """What ends a run from outside: see `Interrupt`."""

    def __init__(self, told: Terminal) -> None:
        self._told = told
        self.exit_code = 0

    @contextlib.contextmanager
    def __call__(self, run: Run) -> Iterator[None]:
        with Interrupt(run.last_words) as interrupt:
            interrupt.at_first(run.stop, partial(self._told.event, _INTERRUPTED))
            try:
                yield
            finally:
                self.exit_code = interrupt.exit_code


class Terminal(Listener):
    """Notes on the standard output; a progress line, and what happens meanwhile, on the standard error."""

    def __init__(self) -> None:
        self._progress: Progress | None = None

    def note(self, line: str) -> None:
        """On the standard output."""
        self.clear()
        print(line, flush=True)

    def event(self, line: str) -> None:
        """A line of its own, above the bar."""
        if self._progress is None:
            print(line, file=sys.stderr, flush=True)
        else:
            self._progress.event(line)

    def begin(self, total: int | None) -> None:
        """From now on there is a bar."""
        self._progress = Progress(total)

    def frame(self, tally: Tally, status: str) -> None:
        """Draws anew if it is time."""
        if self._progress is not None:
            self._progress.frame(tally, status)

    def doing(self, what: str) -> None:
        """On a terminal, in place of the bar."""
        if self._progress is not None:
            self._progress.doing(what)

    def clear(self) -> None:
        """Takes the bar away."""
        if self._progress is not None:
            self._progress.clear()
