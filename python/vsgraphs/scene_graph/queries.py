"""Questions to a scene graph."""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vsgraphs.errors import InputError

if TYPE_CHECKING:
    from vsgraphs.scene_graph.graph import SceneGraph
    from vsgraphs.scene_graph.kinds import RoomNode
    from vsgraphs.trajectory import Array

_UNKNOWN_HEIGHT_M = 3.0  # a room whose ceiling nobody saw
_BELOW_FLOOR_M = 0.3


@dataclass(frozen=True)
class RoomPath:
    """rooms: ids, both ends included. doors: ids, one fewer. length_m: middle to door to door to middle."""

    rooms: list[int]
    doors: list[int]
    length_m: float


def inside_polygon(points: Array, polygon: Array) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """(N, 2) points, (M, 2) corners of a simple polygon -> (N,) whether inside (odd crossings of a ray)."""
    inside = np.zeros(len(points), dtype=bool)
    for (ax, ay), (bx, by) in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        crosses = (ay > points[:, 1]) != (by > points[:, 1])
        if ay != by and crosses.any():  # else the edge may be too flat to divide by
            inside ^= crosses & (points[:, 0] < ax + (points[:, 1] - ay) / (by - ay) * (bx - ax))
    return inside


def room_at(graph: SceneGraph, point: Array) -> RoomNode | None:
    """See SceneGraph.room_at. Of several rooms above one another, the one whose floor is nearest below."""
    if graph.rooms and not graph.frame.levelled:
        raise InputError(
            "the scene graph is not levelled: which way is up is not known, nor what lies in a room"
        )
    best: tuple[float, RoomNode] | None = None
    for room in graph.rooms.values():
        above = float(point[2] - room.polygon[:, 2].mean()) if len(room.polygon) else -np.inf
        if not -_BELOW_FLOOR_M <= above <= (room.height_m or _UNKNOWN_HEIGHT_M):
            continue
        if inside_polygon(point[None, :2], room.polygon[:, :2])[0] and (best is None or above < best[0]):
            best = above, room
    return None if best is None else best[1]


def neighbours(graph: SceneGraph, room: RoomNode) -> dict[int, list[int]]:
    """See SceneGraph.neighbours."""
    found: dict[int, list[int]] = {}
    for door in graph.doors.values():
        if room.id in door.rooms:
            other = door.rooms[1] if door.rooms[0] == room.id else door.rooms[0]
            if other is not None and other != room.id:
                found.setdefault(other, []).append(door.id)
    return dict(sorted(found.items()))


def path_between(graph: SceneGraph, start: RoomNode, goal: RoomNode) -> RoomPath | None:
    """See SceneGraph.path_between. Dijkstra over (room, door it was entered by); equal lengths by ids."""
    queue: list[tuple[float, list[int], list[int]]] = [(0.0, [start.id], [])]
    done: set[tuple[int, int | None]] = set()
    best: RoomPath | None = None
    while queue:
        length, rooms, doors = heapq.heappop(queue)
        if best is not None and length >= best.length_m:
            break
        state = rooms[-1], doors[-1] if doors else None
        if state in done:
            continue
        done.add(state)
        here = graph.doors[doors[-1]].center if doors else start.centroid
        if rooms[-1] == goal.id:
            last = float(np.linalg.norm(goal.centroid - here)) if doors else 0.0
            if best is None or length + last < best.length_m:
                best = RoomPath(rooms, doors, length + last)
            continue
        for other, through in neighbours(graph, graph.rooms[rooms[-1]]).items():
            for door in through:
                step = float(np.linalg.norm(graph.doors[door].center - here))
                heapq.heappush(queue, (length + step, [*rooms, other], [*doors, door]))
    return best
