"""A terminal, or a pipe, that goes away while a program still has something to say."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator
from typing import Any, TextIO, cast


@contextlib.contextmanager
def that_may_go() -> Iterator[None]:
    """While entered, printing never fails: what nobody reads any more goes nowhere."""
    with contextlib.ExitStack() as stack:
        for redirect, stream in (
            (contextlib.redirect_stdout, sys.stdout),
            (contextlib.redirect_stderr, sys.stderr),
        ):
            if stream is not None:  # closed when the program started
                stack.enter_context(redirect(cast("TextIO", _Hardy(stream))))
        yield


class _Hardy:
    """A text stream whose file becomes /dev/null once it cannot be written to."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        with contextlib.suppress(ValueError):  # closed
            try:
                self._stream.write(text)
            except OSError:
                self._let_go()
        return len(text)

    def flush(self) -> None:
        with contextlib.suppress(ValueError):
            try:
                self._stream.flush()
            except OSError:
                self._let_go()

    def _let_go(self) -> None:
        """The descriptor stays, so that nobody else who writes to it fails, nor the flush at the end."""
        with contextlib.suppress(OSError, ValueError):
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, self._stream.fileno())
            os.close(nowhere)
            self._stream.flush()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)
