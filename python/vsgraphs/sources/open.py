"""From what somebody names to a source."""

from __future__ import annotations

from pathlib import Path

from vsgraphs.datasets import open_sequence
from vsgraphs.errors import InputError
from vsgraphs.plugins import plugin, plugins
from vsgraphs.sources.foreign import ForeignSource
from vsgraphs.sources.source import Source


def open_source(what: str | Path, camera: str | None = None) -> Source:
    """A recorded sequence's folder, or "NAME:TEXT" for a plug-in's source of that name, opened.

    camera: of a folder, a camera.yaml, the name of a known camera, or None for what the folder holds. Raises
    InputError as `open_sequence` does, and for plug-ins that are not there or fail.
    """
    if not names_plugin(what):
        return open_sequence(what, camera)
    name, _, rest = str(what).partition(":")
    if camera is not None:
        raise InputError(f"--camera goes with a folder; the source {name} says its camera itself")
    maker = plugin("source", name)
    return ForeignSource(maker.call(rest), maker)


def names_plugin(what: str | Path) -> bool:
    """Whether it is no folder, but what a plug-in's source is called, with a colon after it."""
    name, colon, _ = str(what).partition(":")
    return bool(colon) and not Path(what).exists() and name in plugins("source")
