"""Regular files only: a pipe waits for ever, a device never ends, and neither says so."""

from __future__ import annotations

import os
import stat
from pathlib import Path
from typing import BinaryIO

from vsgraphs.errors import InputError
from vsgraphs.reading.shown import shortened

# Bytes. What people write (cameras, options, plans) and what programs write (trajectories, scene graphs).
SMALL = 10_000_000
LARGE = 2_000_000_000
_CHUNK = 1 << 20

_KINDS = (
    (stat.S_ISDIR, "a folder; give a file"),
    (stat.S_ISFIFO, "a pipe, not a regular file; save it as one and give that"),
    (stat.S_ISSOCK, "a socket, not a regular file"),
    (lambda _: True, "a device, not a regular file"),
)


def open_regular(path: Path, purpose: str) -> BinaryIO:
    """Opens a regular file for reading; anything else is refused without waiting for it.

    Raises InputError, which names `purpose` ("camera file"), the file and what is wrong with it.
    """
    _require_regular(
        _status(path, purpose).st_mode, path, purpose
    )  # first: opening a device may do something
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC | os.O_NOCTTY)
    except OSError as error:
        raise _unreadable(path, purpose, error) from None
    file = os.fdopen(descriptor, "rb")
    try:
        _require_regular(os.fstat(descriptor).st_mode, path, purpose)  # it may be another one by now
    except InputError:
        file.close()
        raise
    return file


def read_bytes(path: Path, purpose: str, limit: int = SMALL) -> bytes:
    """All of a regular file of at most `limit` bytes. Raises InputError that names `purpose` and the file."""
    with open_regular(path, purpose) as file:
        try:
            size = os.fstat(file.fileno()).st_size
            data = b"" if size > limit else _content(file.fileno(), limit + 1)
        except OSError as error:
            raise _unreadable(path, purpose, error) from None
    if max(size, len(data)) > limit:
        raise InputError(
            f"{purpose} {_named(path)} is larger than {limit // 1_000_000} MB; is it the right file?"
        )
    return data


def read_text(
    path: Path, purpose: str, limit: int = SMALL, *, expected: str = "", damaged: bool = False
) -> str:
    """As `read_bytes`, as text in UTF-8. expected: what the file should hold, for the message.

    damaged: bytes that are no UTF-8 are replaced instead of refused; zero bytes never stand in a text.
    """
    data = read_bytes(path, purpose, limit)
    try:
        if b"\0" not in data:
            return data.decode("utf-8-sig", "replace" if damaged else "strict")
    except UnicodeDecodeError:
        pass
    hint = f"; expected {expected}" if expected else ""
    raise InputError(f"{purpose} {_named(path)} is not text{hint}")


def read_head(path: Path, purpose: str, size: int = 65536) -> str:
    """The first bytes of a file as text, to see of what kind it is. Raises InputError."""
    with open_regular(path, purpose) as file:
        try:
            return os.read(file.fileno(), size).decode("utf-8-sig", "replace")
        except OSError as error:
            raise _unreadable(path, purpose, error) from None


def _status(path: Path, purpose: str) -> os.stat_result:
    try:
        return path.stat()
    except OSError as error:
        raise _unreadable(path, purpose, error) from None
    except ValueError as error:  # a zero byte in its name
        raise InputError(f"cannot read {purpose} {_named(path)}: {error}") from None


def _unreadable(path: Path, purpose: str, error: OSError) -> InputError:
    return InputError(f"cannot read {purpose} {_named(path)}: {error.strerror or error}")


def _content(descriptor: int, most: int) -> bytes:
    parts = []
    while most > 0 and (part := os.read(descriptor, min(most, _CHUNK))):
        parts.append(part)
        most -= len(part)
    return b"".join(parts)


def _require_regular(mode: int, path: Path, purpose: str) -> None:
    if not stat.S_ISREG(mode):
        kind = next(words for is_that, words in _KINDS if is_that(mode))
        raise InputError(f"cannot read {purpose} {_named(path)}: it is {kind}")


def _named(path: Path) -> str:
    return shortened(str(path), 300)
