"""Errors a user can cure. Every message is one line that names the file or key and what to do."""

from __future__ import annotations

import errno
import sys

_NO_ROOM = ("can't start new thread", "failed to map segment", "annot allocate memory")


class InputError(ValueError):
    """What the user gave cannot be used: a file, an option, an array of the wrong shape."""


class RunError(RuntimeError):
    """A run cannot go on as it was asked to: a replay departs from its schedule."""


class FrameError(InputError):
    """One frame of a sequence cannot be read (missing, truncated, wrong size). The others still can."""


class StalledError(FrameError):
    """The images of one frame did not come within the time limit: a disk or network that does not answer."""


def is_mistake(error: Exception) -> bool:
    """Whether the user can cure it: our InputError, the compiled module's, an unusable machine or file."""
    if isinstance(error, InputError | RunError | ImportError | OSError) or is_want_of_memory(error):
        return True
    compiled = getattr(sys.modules.get("vsgraphs._core"), "InputError", InputError)
    return isinstance(error, compiled)


def is_want_of_memory(error: BaseException | None) -> bool:
    """Whether that is what is behind it: libraries and threads that find no room say so in their own ways."""
    for _ in range(5):
        if error is None:
            return False
        no_room = isinstance(error, OSError) and error.errno == errno.ENOMEM
        if isinstance(error, MemoryError) or no_room or any(sign in str(error) for sign in _NO_ROOM):
            return True
        error = error.__cause__ or error.__context__
    return False
