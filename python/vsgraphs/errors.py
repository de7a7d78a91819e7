"""Errors a user can cure. Every message is one line that names the file or key and what to do."""


class InputError(ValueError):
    """What the user gave cannot be used: a file, an option, an array of the wrong shape."""


class RunError(RuntimeError):
    """A run cannot go on as it was asked to: a replay departs from its schedule."""


class FrameError(InputError):
    """One frame of a sequence cannot be read (missing, truncated, wrong size). The others still can."""


class StalledError(FrameError):
    """The images of one frame did not come within the time limit: a disk or network that does not answer."""
