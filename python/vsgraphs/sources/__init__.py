"""Where frames come from: folders, cameras, whatever has a `camera` and `frames` (see `Source`)."""

from vsgraphs.sources.facts import Facts, camera_of, facts_of
from vsgraphs.sources.feed import Feed, feed_of
from vsgraphs.sources.loaded import LoadedFrame
from vsgraphs.sources.open import names_plugin, open_source
from vsgraphs.sources.source import Depth, Frame, ImageFrame, Rgb, Source

__all__ = [
    "Depth",
    "Facts",
    "Feed",
    "Frame",
    "ImageFrame",
    "LoadedFrame",
    "Rgb",
    "Source",
    "camera_of",
    "facts_of",
    "feed_of",
    "names_plugin",
    "open_source",
]
