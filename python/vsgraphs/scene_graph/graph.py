"""The scene graph: keyframes, building components, rooms, floors, doors, markers, places, and relations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from vsgraphs.errors import InputError
from vsgraphs.reading import shown
from vsgraphs.scene_graph import levelling, queries
from vsgraphs.scene_graph.edges import Edge
from vsgraphs.scene_graph.frame import Frame
from vsgraphs.scene_graph.from_map import fill_from_map
from vsgraphs.scene_graph.kinds import (
    DoorNode,
    ElementNode,
    FloorNode,
    KeyframeNode,
    MarkerNode,
    PlaceNode,
    PlaneNode,
    RoomNode,
    sections,
)
from vsgraphs.scene_graph.networks import to_networkx

if TYPE_CHECKING:
    from vsgraphs.trajectory import Array


@dataclass(eq=False)
class SceneGraph:
    """Nodes by id, in ascending order of id, and edges. Coordinates are in `frame`, metres.

    elements: by section, as it is called in the file, what has no attribute of its own here. estimated: the
    sections that whoever made the graph looked for at all. An empty section in it means that none was found;
    one that is not in it, that nobody looked.
    """

    frame: Frame = field(default_factory=Frame)
    keyframes: dict[int, KeyframeNode] = field(default_factory=dict)
    planes: dict[int, PlaneNode] = field(default_factory=dict)
    rooms: dict[int, RoomNode] = field(default_factory=dict)
    floors: dict[int, FloorNode] = field(default_factory=dict)
    doors: dict[int, DoorNode] = field(default_factory=dict)
    markers: dict[int, MarkerNode] = field(default_factory=dict)
    places: dict[int, PlaceNode] = field(default_factory=dict)
    elements: dict[str, dict[int, ElementNode]] = field(default_factory=dict)
    edges: list[Edge] = field(default_factory=list)
    estimated: frozenset[str] = field(default_factory=lambda: frozenset(sections()))

    @classmethod
    def from_map(cls, raw: Mapping[str, Any], keyframes: tuple[Any, Any, Any]) -> SceneGraph:
        """The graph of a map snapshot, levelled where `up` is known.

        raw: `snapshot.scene_graph()`; keyframes: `snapshot.keyframes()`, ids (N,), timestamps (N,) seconds,
        world_from_camera (N, 4, 4); both in the map's frame. Raises InputError for values that are not
        finite and for references to nodes that are not there.
        """
        graph = cls()
        fill_from_map(graph, raw, keyframes)
        return graph

    def section(self, name: str) -> dict[int, Any]:
        """The nodes of a section of the file, by id: "rooms" are `rooms`; empty for one that nobody knows."""
        nodes: dict[int, Any] = getattr(self, name) if name in _OWN else self.elements.get(name, {})
        return nodes

    def set_section(self, name: str, nodes: dict[int, Any]) -> None:
        """Replaces the nodes of a section."""
        if name in _OWN:
            setattr(self, name, nodes)
        else:
            self.elements[name] = nodes

    def poses_from_map(self, poses: Array) -> Array:
        """(N, 4, 4) poses in the map's frame (`slam.trajectory()`, `snapshot.keyframes()`) -> the graph's."""
        return levelling.transform_poses(self.frame.world_from_map, poses)

    def points_from_map(self, points: Array) -> Array:
        """(N, 3) points in the map's frame (`snapshot.landmarks()`) -> the graph's."""
        return levelling.transform_points(self.frame.world_from_map, points)

    def planes_of(self, *roles: str) -> list[PlaneNode]:
        """The planes of these roles, by id."""
        return [plane for plane in self.planes.values() if plane.role in roles]

    def room(self, which: int | str) -> RoomNode:
        """A room by id or name; of equal names the first. Raises InputError."""
        found = next((room for room in self.rooms.values() if which in (room.id, room.name)), None)
        if found is None:
            known = ", ".join(room.name or str(room.id) for room in self.rooms.values()) or "none"
            raise InputError(f"no room {shown(which)} in the scene graph; its rooms: {known}")
        return found

    def room_at(self, point: Array) -> RoomNode | None:
        """The room that (3,) `point` lies in, or above whose floor it is; None outside of all."""
        return queries.room_at(self, np.asarray(point, dtype=np.float64))

    def path_between(self, room_a: int | str, room_b: int | str) -> queries.RoomPath | None:
        """The shortest way through doors from one room's middle to another's; None where there is none."""
        return queries.path_between(self, self.room(room_a), self.room(room_b))

    def neighbours(self, room: int | str) -> dict[int, list[int]]:
        """Rooms next door -> the doors that lead there, both by id."""
        return queries.neighbours(self, self.room(room))

    def to_networkx(self) -> Any:
        """A networkx.MultiDiGraph; see `networks`. Raises InputError where networkx is not installed."""
        return to_networkx(self)


_OWN = ("keyframes", "planes", "rooms", "floors", "doors", "markers", "places")  # attributes of a graph
