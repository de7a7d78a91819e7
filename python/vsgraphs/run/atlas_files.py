"""Atlases of a run: what it starts from, and what it leaves for the next one."""

from __future__ import annotations

import contextlib
import os
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vsgraphs.errors import InputError
from vsgraphs.export.lock import Locks
from vsgraphs.run.atlas_target import AtlasTarget
from vsgraphs.run.listener import Listener

if TYPE_CHECKING:
    from vsgraphs.run.request import RunRequest

DEFAULT_NAME = "atlas.vsg"
# The thread that saves gives way to tracking and mapping.
_NICENESS = 10


@dataclass
class AtlasFiles:
    """Which file is loaded, which is saved, and how often."""

    load: Path | None = None
    target: AtlasTarget | None = None
    every_s: float | None = None
    warnings: list[str] = field(default_factory=list)
    listener: Listener = field(default_factory=Listener)
    _make: Callable[[Any], Any] = field(init=False, repr=False)  # a Slam -> its Atlas
    _saved: tuple[int, int] | None = None  # keyframes and version of the map when it was saved last

    @staticmethod
    def of(request: RunRequest, out: Path, locks: Locks, listener: Listener) -> AtlasFiles:
        """Of a request; checks what can be known before anything runs, and holds what will be written. Raises
        InputError.
        """
        load = None if request.load_atlas is None else Path(request.load_atlas)
        save_to = None if request.save_atlas is None else Path(request.save_atlas)
        if save_to is None and request.autosave_s is not None:
            save_to = out / DEFAULT_NAME
        if request.localise_only and load is None:
            raise InputError("--localise-only needs maps to locate the camera in: give --load-atlas FILE")
        target = None
        if save_to is not None:
            from vsgraphs.compiled import core

            target = AtlasTarget.claim(
                core(), save_to, load, overwrite=request.overwrite, keep=request.keep, locks=locks
            )
        return AtlasFiles(load, target, request.autosave_s, listener=listener)

    def start(self, core: Any, config: Any, camera: Any) -> Any:
        """A Slam, started from the loaded maps if there are any. Raises InputError where they do not fit."""
        self._make = lambda slam: core.Atlas(slam.atlas_state(), config, camera)
        if self.load is None:
            return core.Slam(config, camera)
        atlas = core.load_atlas(self.load)
        if self.target is not None:
            self.target.loaded(atlas.revision)
        if atlas.empty and config.get("system.localise_only"):
            raise InputError(f"{self.load}: holds an empty map: there is nothing to locate the camera in")
        if atlas.empty:
            self.listener.note(f"{self.load}: holds an empty map, starting anew")
            return core.Slam(config, camera)
        atlas.require_fit(config, camera, str(self.load))
        self.listener.note(f"{self.load}: {_told(atlas)}")
        return core.Slam(config, camera, atlas.state)

    @contextlib.contextmanager
    def saved_meanwhile(self, slam: Any, tell: Callable[[str], None]) -> Iterator[None]:
        """Saves every few seconds in a thread of its own, if asked to, as long as the context lasts."""
        if self.every_s is None:
            yield
            return
        stop = threading.Event()
        thread = threading.Thread(target=self._save_repeatedly, args=(slam, tell, stop), name="autosave")
        thread.start()
        try:
            yield
        finally:
            stop.set()
            thread.join()

    def save(self, slam: Any) -> None:
        """Saves at the end, if asked to, and says so. Raises InputError where the file cannot be written."""
        if self.target is None:
            return
        atlas = self._make(slam)
        if atlas.empty and self.target.occupied():
            self.listener.note(f"{self.target.path}: left as it is, since this run has mapped nothing")
            return
        try:
            self._tell_moved(self.target.save(atlas), self._warn)
        except Exception as error:
            wanted = self.target.path
            try:
                self.target.save_beside(atlas)
            except Exception:
                raise error from None
            self._warn(f"{error}; saved in another file instead of {wanted}")
        size_mb = self.target.path.stat().st_size / 1e6
        what = "an empty map" if atlas.empty else _told(atlas)
        self.listener.note(f"saved in {self.target.path}: {what}, {size_mb:.1f} MB")

    @property
    def save_to(self) -> Path | None:
        """The file that is written, or was; None where none is."""
        return None if self.target is None else self.target.path

    def save_in(self, folder: Path, slam: Any) -> bool:
        """Where `save` failed: saves in another folder, under a name that is free there. Whether it could."""
        if self.target is None or self.target.path.absolute().parent == folder.absolute():
            return False
        atlas = self._make(slam)
        if atlas.empty:
            return False
        try:
            self.target.save_in(folder, atlas)
        except Exception:
            return False
        return True

    def _warn(self, line: str) -> None:
        self.listener.event(f"warning: {line}")

    def _tell_moved(self, line: str | None, tell: Callable[[str], None]) -> None:
        if line is not None:
            self.warnings.append(line)
            tell(line)

    def _save_repeatedly(self, slam: Any, tell: Callable[[str], None], stop: threading.Event) -> None:
        with contextlib.suppress(OSError, AttributeError):
            os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), _NICENESS)
        while not stop.wait(self.every_s):
            try:
                self._save_if_changed(slam, lambda line: tell(f"warning: {line}"))
            except Exception as error:  # a full disk must not end the run: it may have room again next time
                line = f"autosave: {error}"
                if line not in self.warnings:
                    self.warnings.append(line)
                    tell(f"warning: {line}")

    def _save_if_changed(self, slam: Any, tell: Callable[[str], None]) -> None:
        atlas = self._make(slam)
        now = (atlas.state.keyframes, atlas.snapshot().version if len(atlas) else 0)
        if atlas.empty or now == self._saved:
            return
        if self.target is not None:
            self._tell_moved(self.target.save(atlas), tell)
        self._saved = now


def _told(atlas: Any) -> str:
    info = atlas.info()
    maps = "1 map" if info["maps"] == 1 else f"{info['maps']} maps"
    return f"{maps}, {info['keyframes']} keyframes, {info['landmarks']} landmarks, {info['rooms']} rooms"
