"""Where frames come from: folders, cameras, whatever has a `camera` and `frames` (see `Source`)."""

from vsgraphs.sources.facts import Facts, camera_of, facts_of
from vsgraphs.sources.feed import Feed, feed_of
from vsgraphs.sources.loaded import LoadedFrame
from vsgraphs.sources.open import open_source
from vsgraphs.sources.source import Frame, ImageFrame, Source

__all__ = [
    "Facts",
    "Feed",
    "Frame",
    "ImageFrame",
    "LoadedFrame",
    "Source",
    "camera_of",
    "facts_of",
    "feed_of",
    "open_source",
]
