"""Pillars and columns, as a segmenter calls them."""

from __future__ import annotations

from vsgraphs.scene_graph.kinds.element import ElementKind
from vsgraphs.scene_graph.kinds.kind import SparkPlace


class PillarKind(ElementKind):
    """Not sought without a segmenter."""

    name, section = "pillar", "pillars"
    colour = (150, 120, 90)
    spark = SparkPlace("objects", "I", ("pillar",))
    description = "A pillar or column that stands in a room."
    truth = "pillars"
