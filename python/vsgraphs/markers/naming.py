"""Rooms and doors take the names of the markers that hang there."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from vsgraphs.scene_graph import edges_at, inside_polygon, ordered

if TYPE_CHECKING:
    from vsgraphs.markers.registry import MarkerRegistry
    from vsgraphs.scene_graph import DoorNode, MarkerNode, RoomNode, SceneGraph
    from vsgraphs.trajectory import Array

_NEAR_WALL_M = 0.3  # a print lies on a wall's face; so far may the two be off from each other
_UNKNOWN_HEIGHT_M = 3.0
_NEAR_DOOR_M = 2.0  # from the middle of the threshold: prints hang beside the frame, at eye level


def name_by_markers(graph: SceneGraph, registry: MarkerRegistry) -> list[str]:
    """Gives `graph`'s markers, rooms and doors the registry's names; returns warnings, a line each.

    Every marker learns its room. A room takes name and kind from markers of kind room or corridor, a door its
    name from the door markers nearest to it. Where markers contradict each other (two names for one room, one
    name for two rooms) nothing takes a name.
    """
    if graph.rooms and not graph.frame.levelled:
        return ["markers: nothing was named: which way is up is not known, nor what lies in a room"]
    for marker in graph.markers.values():
        room = room_of_marker(graph, marker)
        marker.room = None if room is None else room.id
        named = registry.markers.get(marker.id)
        marker.name = "" if named is None else named.name
        if named is not None and named.kind == "door":
            door = _door_of(graph, marker)
            marker.door = None if door is None else door.id
    warnings = _unseen(graph, registry) + _homeless(graph, registry)
    for kind, section in (("room", graph.rooms), ("door", graph.doors)):
        claims: dict[int, list[MarkerNode]] = {}
        for marker in graph.markers.values():
            place = marker.door if kind == "door" else marker.room
            if marker.name and place is not None and _claims(registry, marker, kind):
                claims.setdefault(place, []).append(marker)
        warnings += _settle(kind, claims)
        for place, markers in claims.items():
            speakers = [marker for marker in markers if marker.name]
            if speakers:
                section[place].name = speakers[0].name
                if kind == "room":
                    section[place].kind = registry.markers[speakers[0].id].kind
    graph.edges = ordered(
        [edge for edge in graph.edges if edge.kind != "names"] + list(edges_at(graph, "markers"))
    )
    return warnings


def told_of_two_places(raw: Mapping[str, Any]) -> list[str]:
    """Warnings on the markers of `snapshot.scene_graph()` that hang in two places; such are in no graph."""
    warnings = []
    for row in raw.get("markers") or ():
        if not row["in_two_places"]:
            continue
        first, second = row["places"][:2]
        apart = float(np.linalg.norm(np.asarray(first["position"]) - np.asarray(second["position"])))
        counts = f"{len(first['observed_by'])} and {len(second['observed_by'])} keyframes"
        warnings.append(
            f"markers: marker {row['id']} was seen in two places, {apart:.2f} m apart ({counts}): rejected; "
            "hang each number once"
        )
    return warnings


def room_of_marker(graph: SceneGraph, marker: MarkerNode) -> RoomNode | None:
    """The room whose walls enclose the marker: it is inside or on a wall's face, and looks inwards.

    Walls are taken by the room's polygon, so that rooms need not be convex. Of several the one whose outline
    is nearest.
    """
    place, outwards = marker.world_from_marker[:3, 3], marker.world_from_marker[:3, 2]
    before = (
        place + _NEAR_WALL_M * outwards
    )  # a step out of the paper: on the side of the wall it is read from
    best: tuple[float, RoomNode] | None = None
    for room in graph.rooms.values():
        if len(room.polygon) < 3:
            continue
        above = float(place[2] - room.polygon[:, 2].mean())
        if not -_NEAR_WALL_M <= above <= (room.height_m or _UNKNOWN_HEIGHT_M) + _NEAR_WALL_M:
            continue
        outline = room.polygon[:, :2]
        outside_m = 0.0 if inside_polygon(place[None, :2], outline)[0] else _distance_to(outline, place[:2])
        if outside_m > _NEAR_WALL_M or not inside_polygon(before[None, :2], outline)[0]:
            continue
        if best is None or outside_m < best[0]:
            best = outside_m, room
    return None if best is None else best[1]


def _claims(registry: MarkerRegistry, marker: MarkerNode, kind: str) -> bool:
    return (registry.markers[marker.id].kind == "door") == (kind == "door")


def _door_of(graph: SceneGraph, marker: MarkerNode) -> DoorNode | None:
    flat = [
        (float(np.linalg.norm(door.center[:2] - marker.world_from_marker[:2, 3])), door.id)
        for door in graph.doors.values()
        if -_NEAR_WALL_M <= marker.world_from_marker[2, 3] - door.center[2] <= _UNKNOWN_HEIGHT_M
    ]
    nearest = min(flat, default=None)
    return None if nearest is None or nearest[0] > _NEAR_DOOR_M else graph.doors[nearest[1]]


def _settle(kind: str, claims: dict[int, list[MarkerNode]]) -> list[str]:
    """Takes the name from markers that contradict each other."""
    warnings = []
    silenced: list[MarkerNode] = []
    places: dict[str, list[int]] = {}
    for place, markers in claims.items():
        names = sorted({marker.name for marker in markers})
        if len(names) > 1:
            warnings.append(
                f"markers: one {kind} has the names {_quoted(names)} by markers {_ids(markers)}: not named"
            )
            silenced += markers
        for name in names:
            places.setdefault(name, []).append(place)
    for name, there in places.items():
        if len(there) > 1:
            owners = [marker for place in there for marker in claims[place] if marker.name == name]
            warnings.append(
                f"markers: {kind} '{name}' is named by markers {_ids(owners)}, "
                f"which hang at different {kind}s: not named"
            )
            silenced += owners
    for marker in silenced:
        marker.name = ""
    return warnings


def _unseen(graph: SceneGraph, registry: MarkerRegistry) -> list[str]:
    unseen = [number for number in registry.markers if number not in graph.markers]
    if not unseen:
        return []
    numbers = ", ".join(f"{number} ('{registry.markers[number].name}')" for number in unseen)
    return [f"markers: of the marker file these are not in the map: {numbers}"]


def _homeless(graph: SceneGraph, registry: MarkerRegistry) -> list[str]:
    warnings = []
    for marker in graph.markers.values():
        if not marker.name:
            continue
        at_door = registry.markers[marker.id].kind == "door"
        if (marker.door if at_door else marker.room) is None:
            what = "near no door" if at_door else "in no room"
            warnings.append(f"markers: marker {marker.id} ('{marker.name}') hangs {what} that was found")
            marker.name = ""
    return warnings


def _distance_to(outline: Array, point: Array) -> float:
    along = np.roll(outline, -1, axis=0) - outline
    lengths = np.maximum(np.einsum("ij,ij->i", along, along), 1e-12)
    shares = np.clip(np.einsum("ij,ij->i", point - outline, along) / lengths, 0, 1)
    return float(np.linalg.norm(outline + shares[:, None] * along - point, axis=1).min())


def _quoted(names: Iterable[str]) -> str:
    return ", ".join(f"'{name}'" for name in names)


def _ids(markers: Iterable[MarkerNode]) -> str:
    return ", ".join(str(number) for number in sorted(marker.id for marker in markers))
