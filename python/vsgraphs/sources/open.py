"""From what somebody names to a source."""

from __future__ import annotations

from pathlib import Path

from vsgraphs.datasets import open_sequence
from vsgraphs.sources.source import Source


def open_source(what: str | Path, camera: str | None = None) -> Source:
    """A recorded sequence's folder, opened; raises InputError as `open_sequence` does.

    camera: a camera.yaml, the name of a known camera, or None for what the source says itself.
    """
    return open_sequence(what, camera)
