"""A user's mistake gets one line; a mistake of ours gets one line and, with --debug, the trace."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator

from vsgraphs.errors import InputError, RunError

EXIT_MISTAKE = 2  # something the user can cure
EXIT_DEFECT = 1  # something only we can cure
EXIT_INTERRUPTED = 130

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
        _say("interrupted")
        sys.exit(EXIT_INTERRUPTED)
    except BrokenPipeError:  # `vsgraphs config | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(EXIT_DEFECT)
    except Exception as error:
        if _debug:
            raise
        if is_mistake(error):
            _say(f"error: {error}")
            sys.exit(EXIT_MISTAKE)
        _say(
            f"error: unexpected {type(error).__name__}: {' '.join(str(error).split())} "
            "(a defect: please report it with the output of the same command under `vsgraphs --debug`)"
        )
        sys.exit(EXIT_DEFECT)


def is_mistake(error: Exception) -> bool:
    """Whether the user can cure it: our InputError, the compiled module's, an unusable machine or file."""
    if isinstance(error, InputError | RunError | ImportError | OSError):
        return True
    compiled = getattr(sys.modules.get("vsgraphs._core"), "InputError", InputError)
    return isinstance(error, compiled)


def _say(line: str) -> None:
    with contextlib.suppress(OSError):
        print(line, file=sys.stderr, flush=True)
