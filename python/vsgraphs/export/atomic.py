"""Writing a file so that nobody ever sees half of it."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path

from vsgraphs.errors import InputError

_unfinished: set[Path] = set()


def write_atomically(path: Path, content: str | bytes) -> None:
    """Writes beside `path` and renames; a symbolic link is followed. Raises InputError (no space, no
    permission); an old file then stays.
    """
    data = content.encode("utf-8") if isinstance(content, str) else content
    real = Path(os.path.realpath(path))
    if os.path.lexists(real) and not real.is_file():  # a device, a folder, links that lead in a circle
        raise InputError(f"cannot write {path}: it is no ordinary file; give another name")
    beside = real.with_name(f".{real.name}.{os.getpid()}.part")
    _unfinished.add(beside)
    try:
        with beside.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        beside.replace(real)
    except OSError as error:
        with contextlib.suppress(OSError):
            beside.unlink()
        raise InputError(f"cannot write {path}: {error.strerror or error}") from None
    finally:
        _unfinished.discard(beside)


def remove_unfinished() -> None:
    """For a process that ends while it writes: takes away what would stay of new files. Old ones stay."""
    for beside in list(_unfinished):
        with contextlib.suppress(OSError):
            beside.unlink()


def prepare_directory(path: Path) -> None:
    """Creates the output directory if need be and proves that files can be written there. Raises
    InputError.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except FileExistsError:
        raise InputError(f"output {path} is a file; give a directory") from None
    except OSError as error:
        raise InputError(f"cannot create output directory {path}: {error.strerror or error}") from None
    probe = path / f".writable.{os.getpid()}"
    try:
        probe.write_bytes(b"probe\n")
    except OSError as error:
        raise InputError(f"output directory {path} is not writable: {error.strerror or error}") from None
    finally:
        with contextlib.suppress(OSError):
            probe.unlink()
