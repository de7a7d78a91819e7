"""Whether every id that a node names is there."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from vsgraphs.errors import InputError
from vsgraphs.reading import shown

if TYPE_CHECKING:
    from vsgraphs.scene_graph.graph import SceneGraph

_MOST_CELLS = 20_000_000
_LARGEST_CELL_M = 10.0
_Reference = tuple[str, str, int | None]


def check_references(graph: SceneGraph, source: str) -> None:
    """Raises InputError, which names `source`, at the first id that no node has."""
    for who, section, number in _references(graph):
        if number is not None and number not in getattr(graph, section):
            raise InputError(f"{source}: {who} names {section[:-1]} {number}, which is not there")


def check_extents(graph: SceneGraph, source: str) -> None:
    """As above, for surfaces that no building has: of too many cells, or on axes that are none."""
    for plane in graph.planes.values():
        extent = plane.extent
        first, last = extent.runs[:, 1].astype(float), extent.runs[:, 2].astype(float)
        lengths = [float((axis**2).sum()) for axis in (extent.axis_u, extent.axis_v)]
        if (last < first).any() or (last - first + 1).sum() > _MOST_CELLS or extent.cell_m > _LARGEST_CELL_M:
            raise InputError(f"{source}: plane {plane.id} has an extent without cells or of too many")
        if not all(0.9 < length < 1.1 for length in lengths):
            raise InputError(f"{source}: plane {plane.id} has an extent on axes that are not of length 1")


def check_edges(graph: SceneGraph, source: str) -> None:
    """As above, for the ends of edges."""
    for edge in graph.edges:
        for end in (edge.source, edge.target, edge.via):
            if end is None:
                continue
            kind, _, number = end.partition(":")
            nodes = getattr(graph, f"{kind}s", {})
            if not number.isdecimal() or len(number) > 20 or int(number) not in nodes:
                raise InputError(
                    f"{source}: an edge {shown(edge.kind)} names {shown(end)}, which is not there"
                )


def _references(graph: SceneGraph) -> Iterator[_Reference]:
    for plane in graph.planes.values():
        yield f"plane {plane.id}", "planes", plane.other_face
        yield from ((f"plane {plane.id}", "keyframes", k) for k in plane.observed_by)
    for room in graph.rooms.values():
        yield from ((f"room {room.id}", "planes", wall) for wall in room.walls)
        yield f"room {room.id}", "planes", room.ground
        yield f"room {room.id}", "floors", room.floor
    for floor in graph.floors.values():
        yield from ((f"floor {floor.id}", "rooms", room) for room in floor.rooms)
        yield f"floor {floor.id}", "planes", floor.ground
    for door in graph.doors.values():
        yield from ((f"door {door.id}", "rooms", room) for room in door.rooms)
    for marker in graph.markers.values():
        yield f"marker {marker.id}", "rooms", marker.room
        yield f"marker {marker.id}", "doors", marker.door
        yield from ((f"marker {marker.id}", "keyframes", k) for k in marker.observed_by)
    for place in graph.places.values():
        yield f"place {place.id}", "rooms", place.room
        yield from ((f"place {place.id}", "places", other) for other in place.neighbours)
