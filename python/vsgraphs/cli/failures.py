"""A user's mistake gets one line; a mistake of ours gets one line and, with --debug, the trace."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator

from vsgraphs.errors import InputError, is_mistake, is_want_of_memory
from vsgraphs.reading import shortened

EXIT_MISTAKE = 2  # something the user can cure
EXIT_DEFECT = 1  # something only we can cure
EXIT_INTERRUPTED = 130
_LONGEST = 800  # characters of a line

_debug = False


def set_debug(*, on: bool) -> None:
    """Whether unexpected errors show their trace."""
    global _debug  # noqa: PLW0603  (one process, one command line)
    _debug = on


@contextlib.contextmanager
def told() -> Iterator[None]:
    """Turns exceptions into a line on stderr and an exit code."""
    try:
        yield
    except KeyboardInterrupt:
        say("interrupted")
        sys.exit(EXIT_INTERRUPTED)
    except BrokenPipeError:  # `vsgraphs config | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(EXIT_DEFECT)
    except Exception as error:
        if _debug:
            raise
        if is_mistake(error):
            say(f"error: {line_of(error)}")
            sys.exit(EXIT_MISTAKE)
        say(
            f"error: unexpected {type(error).__name__}: {' '.join(str(error).split())} "
            "(a defect: please report it with the output of the same command under `vsgraphs --debug`)"
        )
        sys.exit(EXIT_DEFECT)


def line_of(error: Exception) -> str:
    """What there is to say of an error, in one line."""
    if is_want_of_memory(error):
        return (
            "not enough memory: close other programs, raise `ulimit -v`, "
            "or give smaller images or fewer frames (--max-frames)"
        )
    if isinstance(error, OSError) and error.strerror:
        if error.filename is not None:
            return f"{shortened(str(error.filename), 300)}: {error.strerror}"
        return f"cannot read or write (the standard output?): {error.strerror}"
    return str(error) if isinstance(error, InputError) else " ".join(str(error).split())


def say(line: str) -> None:
    """One line on stderr, whatever it holds."""
    with contextlib.suppress(OSError):
        print(shortened(line, _LONGEST), file=sys.stderr, flush=True)
