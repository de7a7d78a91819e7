"""A folder that appears whole or not at all."""

from __future__ import annotations

import contextlib
import os
import shutil
from pathlib import Path

from vsgraphs.errors import InputError

MARK = "scene_gt.json"  # written last: a folder that has it is one of ours, and whole


def part_of(final: Path) -> Path:
    """Where this process makes the folder: beside its place, that of a link beside the folder it names."""
    place = Path(os.path.realpath(final))
    return place.parent / f".{place.name}.{os.getpid()}.part"


class FolderInTheMaking:
    """A folder under construction beside its final place; renamed when whole, removed otherwise."""

    def __init__(self, final: Path, *, overwrite: bool) -> None:
        self._named, self._overwrite = final, overwrite
        self._final = Path(os.path.realpath(final))  # a symbolic link to a folder stays
        self.path = part_of(final)
        self._require_room()

    def __enter__(self) -> FolderInTheMaking:
        try:
            self._final.parent.mkdir(parents=True, exist_ok=True)
            self.path.mkdir()
        except OSError as error:
            raise InputError(f"cannot create {self._final}: {error.strerror or error}") from None
        return self

    def _require_room(self) -> None:
        final, overwrite = self._named, self._overwrite
        if final.exists() and not final.is_dir():
            raise InputError(f"output {final} is a file; give a directory")
        if final.is_dir() and any(final.iterdir()) and not (overwrite and (final / MARK).is_file()):
            raise InputError(
                f"output {final} is not empty; choose another directory"
                + ("" if overwrite else ", or allow overwriting if it is an older simulation")
            )

    def keep(self) -> None:
        """Puts the folder in its place. Raises InputError where something has come there meanwhile."""
        self._require_room()
        if self._final.is_dir():
            shutil.rmtree(self._final)
        self.path.replace(self._final)

    def __exit__(self, *_: object) -> None:
        with contextlib.suppress(OSError):
            shutil.rmtree(self.path)
