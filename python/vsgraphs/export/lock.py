"""One program at a time writes a file or a folder: the second is told so at its start, not at its end.

A lock is the kernel's (flock) on a small file beside what it stands for. However a program ends, its locks
end with it: a lock file that is left over, as by `kill -9`, holds nobody up.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import socket
from collections.abc import Callable
from pathlib import Path
from types import TracebackType

from vsgraphs.errors import InputError
from vsgraphs.reading import read_head


class Locks:
    """What this program holds against others, from `hold_*` until `release` or the end of the context.

    tell: takes a line where something cannot be locked, as on a file system without locks: it is not held.
    """

    def __init__(self, tell: Callable[[str], None]) -> None:
        self._tell = tell
        self._held: list[tuple[int, Path]] = []  # descriptors and their files

    def __enter__(self) -> Locks:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.release()

    def hold_file(self, path: Path) -> None:
        """Holds a file, wherever symbolic links lead and whether it is there or not. Raises InputError where
        another program holds it.
        """
        real = Path(os.path.realpath(path))
        self._hold(real.with_name(f".{real.name}.lock"), path)

    def hold_folder(self, path: Path) -> None:
        """Holds a folder, which must be there, likewise."""
        self._hold(path / ".lock", path)

    def still_holds_folder(self, path: Path) -> bool:
        """Whether what was held by `hold_folder` is there still, and not another folder of that name."""
        lock = path / ".lock"
        held = [descriptor for descriptor, name in self._held if name == lock]
        return not held or not os.path.lexists(lock) or any(_is_open_as(d, lock) for d in held)

    def release(self) -> None:
        """Lets go of all and removes the lock files."""
        while self._held:
            descriptor, lock = self._held.pop()
            _held_by_all.pop(descriptor, None)
            _remove(descriptor, lock)
            os.close(descriptor)

    def _hold(self, lock: Path, what: Path) -> None:
        try:
            descriptor = _locked(lock)
        except BlockingIOError:
            raise InputError(
                f"{what}: another vsgraphs writes there{_told_holder(lock)}; wait for its end, "
                "or give another name"
            ) from None
        except OSError as error:
            self._tell(
                f"{what} cannot be locked ({error.strerror or error}): let no other program write there"
            )
            return
        with contextlib.suppress(OSError):  # a full disk: then nobody knows who holds it
            os.ftruncate(descriptor, 0)
            os.pwrite(descriptor, f"{os.getpid()} {socket.gethostname()}\n".encode(), 0)
        self._held.append((descriptor, lock))
        _held_by_all[descriptor] = lock


def _locked(lock: Path) -> int:
    """The open lock file, locked. Raises BlockingIOError where another holds it, OSError where none can."""
    while True:
        descriptor = _opened(lock)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if _is_open_as(descriptor, lock):
                return descriptor
        except OSError:
            os.close(descriptor)
            raise
        os.close(descriptor)  # who held it has removed it meanwhile: once more


def _opened(lock: Path) -> int:
    flags = os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW
    try:
        return os.open(lock, os.O_RDWR | flags, 0o666)
    except PermissionError:
        return os.open(lock, os.O_RDONLY | os.O_CLOEXEC | os.O_NOFOLLOW)  # another user's


def _is_open_as(descriptor: int, path: Path) -> bool:
    """Whether this name still leads to what is open."""
    try:
        named = path.lstat()
    except FileNotFoundError:
        return False
    opened = os.fstat(descriptor)
    return (named.st_dev, named.st_ino) == (opened.st_dev, opened.st_ino)


def _told_holder(lock: Path) -> str:
    try:
        number, host = read_head(lock, "lock").split()
    except ValueError:  # InputError, too
        return ""
    return f" (process {number})" if host == socket.gethostname() else f" (process {number} on {host})"


def _remove(descriptor: int, lock: Path) -> None:
    with contextlib.suppress(OSError):
        if _is_open_as(descriptor, lock):  # nobody else's: the folder may have been made anew
            lock.unlink()


_held_by_all: dict[int, Path] = {}


def remove_lock_files() -> None:
    """For a process that ends at once: the locks end with it, their files would stay."""
    for descriptor, lock in list(_held_by_all.items()):
        _remove(descriptor, lock)


def _let_go_in_child() -> None:
    """A forked child would keep the locks of a parent that is gone."""
    while _held_by_all:
        descriptor, _ = _held_by_all.popitem()
        with contextlib.suppress(OSError):
            os.close(descriptor)


os.register_at_fork(after_in_child=_let_go_in_child)
