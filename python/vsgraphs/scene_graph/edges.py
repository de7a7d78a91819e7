"""Typed relations between the nodes, each with the factor of the optimisation that stands behind it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from vsgraphs.scene_graph.graph import SceneGraph

# In the order they stand in a file. None: a relation that no factor holds.
FACTORS: dict[str, str | None] = {
    "observes_plane": "plane_observation",  # keyframe -> plane
    "observes_marker": "marker",  # keyframe -> marker
    "wall_perpendicular_to_ground": "wall_perpendicular_to_ground",  # plane -> plane
    "parallel": "wall_pair_parallel",  # plane - plane, facing walls of one room
    "perpendicular": "wall_pair_perpendicular",  # plane - plane
    "other_face": None,  # plane - plane, two faces of one wall
    "bounds": "room_centroid",  # wall -> room
    "ground_of": None,  # ground -> room
    "belongs_to": "floor_centroid",  # room -> floor
    "door": None,  # room - room, through `via`
    "names": None,  # marker -> room or door
}
SYMMETRIC = frozenset({"parallel", "perpendicular", "other_face", "door"})
NODE_KINDS = ("keyframe", "plane", "room", "floor", "door", "marker", "place")


@dataclass(frozen=True)
class Edge:
    """source and target: "kind:id", as "plane:3". Symmetric kinds are kept once, the smaller id first.

    factor: its name in the optimisation; None where nothing is optimised. via: the door of a door edge.
    """

    kind: str
    source: str
    target: str
    factor: str | None
    via: str | None = None


def node_key(kind: str, number: int) -> str:
    """How edges and networkx name a node."""
    return f"{kind}:{number}"


def ordered(edges: Iterable[Edge]) -> list[Edge]:
    """By kind, then by the ids as numbers; each once."""
    kinds = list(FACTORS)

    def rank(edge: Edge) -> tuple[Any, ...]:
        via = -1 if edge.via is None else _number(edge.via)
        return kinds.index(edge.kind), _number(edge.source), _number(edge.target), via

    return sorted(set(edges), key=rank)


def edges_of(graph: SceneGraph, pairs: Iterable[Mapping[str, Any]] = ()) -> list[Edge]:
    """All edges that follow from the nodes, and the wall pairs of the optimisation.

    pairs: {"planes": [a, b], "relation": "parallel" | "perpendicular" | "wall_perpendicular_to_ground"}, of
    the last one the wall first.
    """
    edges = [*_observations(graph), *sights_and_names_of_markers(graph), *_walls(graph), *_rooms(graph)]
    for pair in pairs:
        relation, (a, b) = str(pair["relation"]), map(int, pair["planes"])
        if relation in SYMMETRIC:
            edges.append(_between(relation, "plane", a, b))
        else:
            edges.append(_edge(relation, node_key("plane", a), node_key("plane", b)))
    return ordered(edges)


def _edge(kind: str, source: str, target: str, via: str | None = None) -> Edge:
    return Edge(kind, source, target, FACTORS[kind], via)


def _between(kind: str, node: str, a: int, b: int, via: str | None = None) -> Edge:
    return _edge(kind, node_key(node, min(a, b)), node_key(node, max(a, b)), via)


def _observations(graph: SceneGraph) -> Iterator[Edge]:
    for plane in graph.planes.values():
        for keyframe in plane.observed_by:
            yield _edge("observes_plane", node_key("keyframe", keyframe), node_key("plane", plane.id))


def sights_and_names_of_markers(graph: SceneGraph) -> Iterator[Edge]:
    """The edges at markers. A marker without a name names nothing."""
    for marker in graph.markers.values():
        key = node_key("marker", marker.id)
        for keyframe in marker.observed_by:
            yield _edge("observes_marker", node_key("keyframe", keyframe), key)
        if marker.name and marker.door is not None:
            yield _edge("names", key, node_key("door", marker.door))
        elif marker.name and marker.room is not None:
            yield _edge("names", key, node_key("room", marker.room))


def _walls(graph: SceneGraph) -> Iterator[Edge]:
    for plane in graph.planes.values():
        if plane.other_face is not None:
            yield _between("other_face", "plane", plane.id, plane.other_face)


def _rooms(graph: SceneGraph) -> Iterator[Edge]:
    for room in graph.rooms.values():
        key = node_key("room", room.id)
        for wall in room.walls:
            yield _edge("bounds", node_key("plane", wall), key)
        if room.ground is not None:
            yield _edge("ground_of", node_key("plane", room.ground), key)
            for wall in room.walls:
                ground = node_key("plane", room.ground)
                yield _edge("wall_perpendicular_to_ground", node_key("plane", wall), ground)
        if room.floor is not None:
            yield _edge("belongs_to", key, node_key("floor", room.floor))
    for door in graph.doors.values():
        first, second = door.rooms
        if first is not None and second is not None:
            yield _between("door", "room", first, second, node_key("door", door.id))


def _number(key: str) -> int:
    return int(key.partition(":")[2])
