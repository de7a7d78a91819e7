"""The standard streams, in whatever state we are given them."""

from __future__ import annotations

import contextlib
import io
import os
import sys

from vsgraphs.cli.failures import EXIT_DEFECT, EXIT_MISTAKE, say


def prepare_streams() -> None:
    """Makes all three usable: a closed one leads nowhere, any name can be printed, and no message is so
    important that a run ends because nobody reads it.
    """
    for number, name, mode in ((0, "stdin", "r"), (1, "stdout", "w"), (2, "stderr", "w")):
        if _is_closed(number):  # else the next file opened, a result, would take its number
            _lead_nowhere(number)
        if getattr(sys, name) is None:
            setattr(sys, name, os.fdopen(number, mode, encoding="utf-8", closefd=False))
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")  # names of files may be any bytes
    sys.stderr = io.TextIOWrapper(
        _Unfailing(), encoding=sys.stderr.encoding, errors="backslashreplace", line_buffering=True
    )


def flush_output() -> None:
    """What a command printed reaches its reader, or it is said that it does not. Raises SystemExit then."""
    try:
        sys.stdout.flush()
    except BrokenPipeError:  # `vsgraphs config | head`
        _lead_nowhere(1)
        sys.exit(EXIT_DEFECT)
    except OSError as error:
        _lead_nowhere(1)  # Python tries again at its end
        say(f"error: cannot write to the standard output: {error.strerror or error}")
        sys.exit(EXIT_MISTAKE)


class _Unfailing(io.RawIOBase):
    """Descriptor 2; what cannot be written is dropped."""

    def writable(self) -> bool:
        return True

    def write(self, data: object) -> int:
        content = memoryview(data).tobytes()  # type: ignore[arg-type]
        left = content
        with contextlib.suppress(OSError):
            while left:
                left = left[os.write(2, left) :]
        return len(content)

    def fileno(self) -> int:
        return 2

    def isatty(self) -> bool:
        return os.isatty(2)


def _is_closed(number: int) -> bool:
    try:
        os.fstat(number)
    except OSError:
        return True
    return False


def _lead_nowhere(number: int) -> None:
    nowhere = os.open(os.devnull, os.O_RDWR)
    if nowhere != number:
        os.dup2(nowhere, number)
        os.close(nowhere)
