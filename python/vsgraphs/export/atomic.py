"""Writing a file so that nobody ever sees half of it."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path

from vsgraphs.errors import InputError

_unfinished: set[Path] = set()


def write_atomically(path: Path, content: str | bytes) -> None:
    """Writes beside `path` and renames; a symbolic link stays, the file it names is written.

    Raises InputError: no space, no permission, a folder, a pipe or a device of that name. An old file then
    stays.
    """
    data = content.encode("utf-8", "backslashreplace") if isinstance(content, str) else content
    try:
        target = _target(path)
        beside = target.with_name(f".{target.name}.{os.getpid()}.part")
    except InputError:
        raise
    except (
        OSError,
        ValueError,
        RuntimeError,
    ) as error:  # too long a name; a circle of links
        raise InputError(f"cannot write {path}: {getattr(error, 'strerror', None) or error}") from None
    _unfinished.add(beside)
    try:
        with beside.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        beside.replace(target)
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


def _target(path: Path) -> Path:
    """The file to replace. Raises InputError for what is no file: replaced, a device would be gone."""
    target = Path(os.path.realpath(path)) if path.is_symlink() else path
    if target.is_symlink():
        raise InputError(f"cannot write {path}: its symbolic links lead in a circle")
    if target.exists() and not target.is_file():
        kind = "a folder" if target.is_dir() else "a pipe or a device, not a regular file"
        raise InputError(f"cannot write {path}: it is {kind}; give the name of a file")
    return target


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
