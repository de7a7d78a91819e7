"""`vsgraphs.run`: a run for scripts and notebooks."""

from __future__ import annotations

import contextlib
import functools
import signal
import threading
from collections.abc import Callable, Iterator
from types import FrameType
from typing import ParamSpec

from vsgraphs.run.conduct import Run
from vsgraphs.run.listener import Callbacks
from vsgraphs.run.request import RunRequest
from vsgraphs.run.result import Result

_P = ParamSpec("_P")
_BLANK = "\n\n"
_DOC = """Tracks a camera through a source of frames and writes what was found.

    Returns a Result. Raises InputError for what can be cured, in one line; what was tracked before is kept
    and written even then. The first Ctrl-C ends the run once the frame under way is done, with the results
    so far (`result.interrupted`); a second one is a KeyboardInterrupt.

"""


def _started(request: Callable[_P, RunRequest]) -> Callable[_P, Result]:
    """A function of the same arguments, so that they are declared once."""

    @functools.wraps(request)
    def run(*arguments: _P.args, **keywords: _P.kwargs) -> Result:
        asked = request(*arguments, **keywords)
        result = Run(asked, Callbacks(asked.on_progress, asked.on_message)).go(ctrl_c_stops)
        if result.failure is not None:
            raise result.failure
        return result

    run.__name__ = run.__qualname__ = "run"
    run.__doc__ = _DOC + (request.__doc__ or "").partition(_BLANK)[2]
    return run


run = _started(RunRequest)


@contextlib.contextmanager
def ctrl_c_stops(running: Run) -> Iterator[None]:
    """While entered, the first Ctrl-C stops the run; the next one does what it did before.

    Only on the main thread, where signals arrive, and where Ctrl-C is heeded at all.
    """
    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or before in (None, signal.SIG_IGN):
        yield
        return

    def heard(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
        signal.signal(signal.SIGINT, before)
        running.stop()

    signal.signal(signal.SIGINT, heard)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
