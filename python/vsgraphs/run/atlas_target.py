"""The file a run saves its atlas in: whose it is, what lies there, and what becomes of that."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from vsgraphs.errors import InputError
from vsgraphs.export.lock import Locks


class AtlasTarget:
    """A file that this run may write, and what is known to lie there: it replaces that and nothing else.

    path: as the user named it; after `save` has had to give way, the file beside it that is written instead.
    """

    def __init__(self, core: Any, path: Path, keep: int) -> None:
        self.path = path
        self.started_from_it = False
        self._core = core
        self._keep = keep  # previous versions, at the next save that replaces what was there before the run
        self._known = self._content()

    @staticmethod
    def claim(
        core: Any, path: Path, load: Path | None, *, overwrite: bool, keep: int, locks: Locks
    ) -> AtlasTarget:
        """Holds the file for this run. Raises InputError where it cannot be written, another program holds
        it, or it is there without `overwrite` and the run does not start from it (`load`, by its content).
        """
        core.require_writable(path)
        locks.hold_file(path)
        target = AtlasTarget(core, path, keep)
        revision = core.atlas_revision(path)
        target.started_from_it = (
            load is not None and revision is not None and core.atlas_revision(load) == revision
        )
        if target._known is not None and not target.started_from_it and not overwrite:
            raise InputError(_refusal(path, load, is_atlas=revision is not None))
        return target

    def occupied(self) -> bool:
        """Whether a file is there now."""
        return self._content() is not None

    def loaded(self, revision: str) -> None:
        """What was loaded from it in the end, where the run started from it."""
        if self.started_from_it:
            self._known = revision

    def save(self, atlas: Any) -> str | None:
        """Writes it. Where something else lies there by now than is known: beside it, under a free name, as
        all that follows. Returns a line that says so, the first time. Raises InputError where it cannot be
        written.
        """
        moved = None
        if self._content() not in (self._known, None):
            moved = f"{self.path} was changed by another program while this one ran, and is left as it is"
            self.path, self._known, self._keep = self._free(self.path), None, 0
        self._known = atlas.save(self.path, keep=self._keep)
        self._keep = 0  # from now on it is this run's own that is replaced
        return moved

    def save_beside(self, atlas: Any) -> None:
        """Where `save` failed for reasons that may lie in that very file. If it fails too, all stays as it
        was.
        """
        self._save_elsewhere(self._free(self.path), atlas)

    def save_in(self, folder: Path, atlas: Any) -> None:
        """Writes it into another folder, under a name that is free there; as `save_beside`."""
        wanted = folder / self.path.name
        self._save_elsewhere(self._free(wanted) if os.path.lexists(wanted) else wanted, atlas)

    def _save_elsewhere(self, path: Path, atlas: Any) -> None:
        asked = self.path, self._known, self._keep
        self.path, self._known, self._keep = path, None, 0
        try:
            self.save(atlas)
        except Exception:
            self.path, self._known, self._keep = asked
            raise

    @staticmethod
    def _free(path: Path) -> Path:
        number = 1
        while os.path.lexists(free := path.with_name(f"{path.stem}-{number}{path.suffix}")):
            number += 1
        return free

    def _content(self) -> str | None:
        """Stands for what lies there: another text for anything else, None for nothing."""
        revision: str | None = self._core.atlas_revision(self.path)
        if revision is not None:
            return revision
        try:
            found = self.path.stat()
        except OSError:
            return None
        return f"{found.st_ino} {found.st_size} {found.st_mtime_ns}"


def _refusal(path: Path, load: Path | None, *, is_atlas: bool) -> str:
    if not is_atlas:
        return (
            f"{path}: is there, and no atlas that can be read; give another name to save in, or --overwrite"
        )
    instead = "" if load is None else f" but from {load}"
    return (
        f"{path}: is there, and this run does not start from it{instead}; give --load-atlas {path} to go on "
        "in it, another name to save in, or --overwrite"
    )
