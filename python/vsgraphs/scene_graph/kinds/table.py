"""The kinds of nodes there are."""

from __future__ import annotations

from typing import Any

from vsgraphs.scene_graph.edges import Relation
from vsgraphs.scene_graph.kinds.ceiling import CeilingKind
from vsgraphs.scene_graph.kinds.door import DoorKind
from vsgraphs.scene_graph.kinds.floor import FloorKind
from vsgraphs.scene_graph.kinds.keyframe import KeyframeKind
from vsgraphs.scene_graph.kinds.kind import Kind
from vsgraphs.scene_graph.kinds.marker import MarkerKind
from vsgraphs.scene_graph.kinds.pillar import PillarKind
from vsgraphs.scene_graph.kinds.place import PlaceKind
from vsgraphs.scene_graph.kinds.plane import PlaneKind
from vsgraphs.scene_graph.kinds.room import RoomKind
from vsgraphs.scene_graph.kinds.window import WindowKind

# In the order of the sections of scene_graph.json. Whatever is made of a graph loops over this.
KINDS: list[Kind[Any]] = [
    KeyframeKind(),
    PlaneKind(),
    RoomKind(),
    FloorKind(),
    DoorKind(),
    CeilingKind(),
    WindowKind(),
    PillarKind(),
    MarkerKind(),
    PlaceKind(),
]


def kind_named(name: str) -> Kind[Any] | None:
    """The kind of this name, as in "plane:3"; None: there is none."""
    return next((kind for kind in KINDS if kind.name == name), None)


def sections() -> tuple[str, ...]:
    """Of scene_graph.json, in their order."""
    return tuple(kind.section for kind in KINDS)


def relations() -> dict[str, Relation]:
    """The kinds of edges by name, in the order they stand in a file: by the kind of node at their source."""
    order = [kind.name for kind in KINDS]
    every = [relation for kind in KINDS for relation in kind.relations]
    found: dict[str, Relation] = {}
    for relation in sorted(every, key=lambda relation: order.index(relation.source)):
        found.setdefault(relation.kind, relation)
    return found
