"""Opening files that other people named: never waits, whatever the name turns out to stand for."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import BinaryIO

_KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a named pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)


class IrregularFileError(OSError):
    """Under that name is no regular file; `strerror` says what is, as in "it is a named pipe, no file"."""


def open_regular(path: Path) -> BinaryIO:
    """Opens a regular file, or a link to one, for reading bytes.

    What could make the reader wait for ever, or never end, is not opened: a named pipe nobody writes to, a
    socket, a device, a folder. Raises IrregularFileError for those and OSError as `open` does.
    """
    # Asked of the open file, since a name may stand for something else a moment later.
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
    except OSError as error:
        if error.errno == errno.ENXIO:
            raise _irregular(path, "a socket") from None
        raise
    mode = os.fstat(descriptor).st_mode
    if not stat.S_ISREG(mode):
        os.close(descriptor)
        raise _irregular(path, next((name for asks, name in _KINDS if asks(mode)), "something else"))
    os.set_blocking(descriptor, True)
    return os.fdopen(descriptor, "rb")


def _irregular(path: Path, kind: str) -> IrregularFileError:
    return IrregularFileError(errno.EINVAL, f"it is {kind}, no file", str(path))
