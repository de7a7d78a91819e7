"""A plug-in's source, so that what it raises is told as the plug-in's and not as a defect of ours."""

from __future__ import annotations

import contextlib
from collections.abc import Generator, Iterator
from typing import Any

from vsgraphs.errors import InputError
from vsgraphs.plugins import Plugin
from vsgraphs.sources.facts import length_of
from vsgraphs.sources.source import Depth, Frame, Rgb, Source


class ForeignSource:
    """The source, all its attributes included; what its frames raise names the plug-in."""

    def __init__(self, source: Source, plugin: Plugin) -> None:
        self._source, self._plugin = source, plugin

    def __getattr__(self, name: str) -> Any:
        return getattr(self._source, name)

    @property
    def name(self) -> str:
        """Its own, or what its class is called."""
        return str(getattr(self._source, "name", type(self._source).__name__))

    @property
    def length(self) -> int | None:
        """How many frames it says there are."""
        return length_of(self._source)

    @property
    def frames(self) -> Generator[Frame]:
        """Its frames; closes its iterator in the end."""
        with _named(self._plugin):
            iterator = iter(self._source.frames)
            try:
                for frame in iterator:
                    yield _ForeignFrame(frame, self._plugin)
            finally:
                close = getattr(iterator, "close", None)
                if close is not None:
                    close()


class _ForeignFrame:
    def __init__(self, frame: Frame, plugin: Plugin) -> None:
        self._frame, self._plugin = frame, plugin
        self.timestamp = frame.timestamp
        self.files = getattr(frame, "files", ())

    def load(self) -> tuple[Rgb, Depth]:
        with _named(self._plugin):
            return self._frame.load()


@contextlib.contextmanager
def _named(plugin: Plugin) -> Iterator[None]:
    try:
        yield
    except (InputError, OSError):  # a message of its own; a file or a device that does not answer
        raise
    except Exception as error:
        raise InputError(plugin.trouble("failed", error)) from error
