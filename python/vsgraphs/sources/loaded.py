"""A frame that has come, with its images or with what kept them away."""

from __future__ import annotations

import time
from dataclasses import dataclass

from vsgraphs.errors import FrameError
from vsgraphs.sources.source import Depth, Frame, Rgb


@dataclass(frozen=True)
class LoadedFrame:
    """A frame with its images, or with the error that kept them from being read.

    begin_s, end_s: when loading began and ended, on the clock of time.monotonic (for the timeline).
    following: the next frame's timestamp, None after the last one and where nobody can know. dropped: came
    while an earlier one was tracked.
    """

    index: int
    timestamp: float
    rgb: Rgb | None
    depth: Depth | None
    error: FrameError | None
    begin_s: float
    end_s: float
    following: float | None = None
    dropped: bool = False


def load(index: int, frame: Frame, following: float | None = None) -> LoadedFrame:
    """Loads a frame; a FrameError becomes part of it, anything else is raised."""
    begin = time.monotonic()
    try:
        rgb, depth = frame.load()
    except FrameError as error:
        return LoadedFrame(index, frame.timestamp, None, None, error, begin, time.monotonic(), following)
    return LoadedFrame(index, frame.timestamp, rgb, depth, None, begin, time.monotonic(), following)
