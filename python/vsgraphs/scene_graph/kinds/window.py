"""Windows in walls, as a segmenter calls them."""

from __future__ import annotations

from vsgraphs.scene_graph.colours import CLASS_COLOURS
from vsgraphs.scene_graph.kinds.element import ElementKind
from vsgraphs.scene_graph.kinds.kind import SparkPlace


class WindowKind(ElementKind):
    """Not sought without a segmenter."""

    name, section = "window", "windows"
    colour = CLASS_COLOURS["window"]
    spark = SparkPlace("objects", "W", ("window opening",))
    description = "A window in a wall, seen from the rooms that it lies in."
    truth = "windows"
