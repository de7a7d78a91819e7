"""From the map's raw values to nodes in a levelled frame."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from vsgraphs.errors import InputError
from vsgraphs.reading import shown
from vsgraphs.scene_graph import levelling
from vsgraphs.scene_graph.consistency import check_edges, check_references
from vsgraphs.scene_graph.edges import edges_of
from vsgraphs.scene_graph.extent import extent_of
from vsgraphs.scene_graph.nodes import (
    ROLES,
    SECTIONS,
    DoorNode,
    FloorNode,
    Frame,
    KeyframeNode,
    MarkerNode,
    PlaceNode,
    PlaneNode,
    RoomNode,
)
from vsgraphs.trajectory import Array

if TYPE_CHECKING:
    from vsgraphs.scene_graph.graph import SceneGraph

Row = Mapping[str, Any]


def fill_from_map(graph: SceneGraph, raw: Row, keyframes: tuple[Any, Any, Any]) -> None:
    """Fills an empty graph; see SceneGraph.from_map."""
    ids, stamps, poses = keyframes
    poses = np.asarray(poses, dtype=np.float64).reshape(-1, 4, 4)
    order = np.argsort(np.asarray(ids), kind="stable")
    up = raw.get("up")
    first = poses[order[0]] if len(order) else np.eye(4)
    frame = levelling.level(None if up is None else _vector(up, "up"), raw.get("planes") or [], first)
    mover = _Mover(frame)
    graph.frame = frame
    graph.estimated = frozenset({"keyframes", *(name for name in SECTIONS if raw.get(name) is not None)})
    moved = levelling.transform_poses(frame.world_from_map, poses)
    graph.keyframes = {int(ids[i]): KeyframeNode(int(ids[i]), float(stamps[i]), moved[i]) for i in order}
    known = set(graph.keyframes)
    graph.planes = {row["id"]: _plane(row, mover, known) for row in _rows(raw, "planes")}
    graph.rooms = {row["id"]: _room(row, mover) for row in _rows(raw, "rooms")}
    graph.floors = {row["id"]: _floor(row, mover) for row in _rows(raw, "floors")}
    graph.doors = {row["id"]: _door(row, mover) for row in _rows(raw, "doors")}
    graph.markers = {
        row["id"]: _marker(row, mover, known)
        for row in _rows(raw, "markers")
        if not row.get("in_two_places", False)  # nobody knows where it is
    }
    graph.places = {row["id"]: _place(row, mover) for row in _rows(raw, "places")}
    check_references(graph, "the map")
    graph.edges = edges_of(graph, raw.get("wall_pairs") or [])
    check_edges(graph, "the map")


class _Mover:
    """Takes the map's geometry into the graph's frame."""

    def __init__(self, frame: Frame) -> None:
        self.frame, self.transform = frame, frame.world_from_map

    def points(self, values: Any, what: str) -> Array:
        points = np.asarray(values, dtype=np.float64).reshape(-1, 3)
        return _finite(levelling.transform_points(self.transform, points), what)

    def point(self, values: Any, what: str) -> Array:
        point: Array = self.points(_vector(values, what), what)[0]
        return point

    def direction(self, values: Any, what: str) -> Array:
        direction: Array = self.transform[:3, :3] @ _vector(values, what)
        return direction


def _rows(raw: Row, name: str) -> list[dict[str, Any]]:
    rows = [{**row, "id": int(row["id"])} for row in raw.get(name) or []]
    return sorted(rows, key=lambda row: int(row["id"]))


def _plane(row: Row, mover: _Mover, keyframes: set[int]) -> PlaneNode:
    what = f"plane {row['id']}"
    if row["role"] not in ROLES:
        raise InputError(f"{what}: unknown role {shown(row['role'])}; known: {', '.join(ROLES)}")
    normal = _vector(row["normal"], f"{what}: normal")
    if abs(np.linalg.norm(normal) - 1) > 1e-3:
        raise InputError(f"{what}: its normal has length {np.linalg.norm(normal):g}, expected 1")
    normal, offset_m = levelling.transform_plane(mover.transform, normal, float(row["d"]))
    points = mover.points(row.get("points", ()), f"{what}: points")
    extent = extent_of(points, normal, offset_m, mover.frame.up)
    middle = extent.cell_centres().mean(axis=0) if len(extent.runs) else mover.point(row["anchor"], what)
    return PlaneNode(
        id=row["id"],
        role=row["role"],
        votes={role: float(votes) for role, votes in sorted((row.get("votes") or {}).items())},
        normal=_finite(normal, what),
        offset_m=offset_m,
        centroid=middle - normal * float(normal @ middle + offset_m),
        extent=extent,
        other_face=_id(row.get("other_face")),
        thickness_m=_number(row.get("thickness_m")) if row.get("other_face") is not None else None,
        observed_by=_ids(set(map(int, row.get("observed_by", ()))) & keyframes),  # others were culled
    )


def _room(row: Row, mover: _Mover) -> RoomNode:
    what = f"room {row['id']}"
    return RoomNode(
        id=row["id"],
        name=str(row.get("name") or ""),
        kind=str(row.get("kind") or "room"),
        walls=_ids(row.get("walls", ())),
        ground=_id(row.get("ground")),
        polygon=mover.points(row["polygon"], f"{what}: polygon"),
        centroid=mover.point(row["centroid"], f"{what}: centroid"),
        height_m=_number(row.get("height_m")),
        area_m2=float(row["area_m2"]),
        partial=bool(row.get("partial", False)),
        floor=_id(row.get("floor")),
    )


def _floor(row: Row, mover: _Mover) -> FloorNode:
    centroid = mover.point(row["centroid"], f"floor {row['id']}: centroid")
    return FloorNode(row["id"], _ids(row.get("rooms", ())), _id(row.get("ground")), centroid)


def _door(row: Row, mover: _Mover) -> DoorNode:
    what = f"door {row['id']}"
    first, second = row["rooms"]
    return DoorNode(
        id=row["id"],
        rooms=(_id(first), _id(second)),
        center=mover.point(row["center"], f"{what}: center"),
        width_m=float(row["width_m"]),
        height_m=_number(row.get("height_m")),
        normal=mover.direction(row["normal"], f"{what}: normal"),
        kind=str(row.get("kind") or "door"),
        name=str(row.get("name") or ""),
    )


def _marker(row: Row, mover: _Mover, keyframes: set[int]) -> MarkerNode:
    pose = np.asarray(row["world_from_marker"], dtype=np.float64).reshape(4, 4)
    return MarkerNode(
        id=row["id"],
        name=str(row.get("name") or ""),
        world_from_marker=_finite(mover.transform @ pose, f"marker {row['id']}"),
        size_m=float(row["size_m"]),
        observed_by=_ids(set(map(int, row.get("observed_by", ()))) & keyframes),
        room=_id(row.get("room")),
        door=_id(row.get("door")),
    )


def _place(row: Row, mover: _Mover) -> PlaceNode:
    position = mover.point(row["position"], f"place {row['id']}: position")
    neighbours = _ids(row.get("neighbours", ()))
    return PlaceNode(row["id"], position, float(row["clearance_m"]), _id(row.get("room")), neighbours)


def _id(value: Any) -> int | None:
    return None if value is None else int(value)


def _ids(values: Iterable[Any]) -> list[int]:
    return sorted(int(value) for value in values)


def _number(value: Any) -> float | None:
    """None and NaN, the core's word for unknown, are None."""
    return None if value is None or not np.isfinite(value) else float(value)


def _vector(values: Any, what: str) -> Array:
    return _finite(np.asarray(values, dtype=np.float64).reshape(3), what)


def _finite(values: Array, what: str) -> Array:
    if not np.isfinite(values).all():
        raise InputError(f"{what}: not finite")
    return values
