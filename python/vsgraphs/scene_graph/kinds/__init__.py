"""The kinds of nodes: each says in one file all there is to say of it; `KINDS` lists them."""

from vsgraphs.scene_graph.kinds.box import Box
from vsgraphs.scene_graph.kinds.door import DoorNode
from vsgraphs.scene_graph.kinds.element import ElementKind, ElementNode
from vsgraphs.scene_graph.kinds.floor import FloorNode
from vsgraphs.scene_graph.kinds.keyframe import KeyframeNode
from vsgraphs.scene_graph.kinds.kind import Kind, SparkPlace, count
from vsgraphs.scene_graph.kinds.marker import MarkerNode
from vsgraphs.scene_graph.kinds.mover import Mover
from vsgraphs.scene_graph.kinds.place import PlaceNode
from vsgraphs.scene_graph.kinds.plane import ROLES, PlaneNode
from vsgraphs.scene_graph.kinds.room import RoomNode
from vsgraphs.scene_graph.kinds.table import KINDS, kind_named, relations, sections

__all__ = [
    "KINDS",
    "ROLES",
    "Box",
    "DoorNode",
    "ElementKind",
    "ElementNode",
    "FloorNode",
    "KeyframeNode",
    "Kind",
    "MarkerNode",
    "Mover",
    "PlaceNode",
    "PlaneNode",
    "RoomNode",
    "SparkPlace",
    "count",
    "kind_named",
    "relations",
    "sections",
]
