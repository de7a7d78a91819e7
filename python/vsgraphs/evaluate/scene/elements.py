"""Structural elements against the true ones: rooms, floors, doors, kinds told by their middle."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from vsgraphs.evaluate.scene.options import SceneOptions
from vsgraphs.evaluate.scene.raster import common_cells, intersection_over_union, rasterise
from vsgraphs.evaluate.scene.scores import Detection, Match, not_estimated
from vsgraphs.evaluate.scene.truth import SceneTruth
from vsgraphs.scene_graph import FloorNode, Kind, RoomNode, SceneGraph, transform_points
from vsgraphs.trajectory import Array

_ROOM_ERRORS = ("iou", "centroid_m")
_FLOOR_ERRORS = ("height_m",)
_MIDDLE_ERRORS = ("center_m",)


def score_rooms(
    graph: SceneGraph, truth: SceneTruth, truth_from_graph: Array, options: SceneOptions
) -> Detection:
    """By intersection over union of the polygons seen from above, the greatest first, each matched once.

    A room that lies mostly in one that is not scored, at any height between its floor and ceiling, is
    ignored, however little of that one it covers.
    """
    required = [room for room in truth.rooms if room.required]
    if "rooms" not in graph.estimated:
        return not_estimated(len(required), _ROOM_ERRORS)
    rooms = {room.id: _outline(room, truth_from_graph) for room in graph.rooms.values()}
    rasters = {number: rasterise(polygon[:, :2]) for number, polygon in rooms.items() if len(polygon) > 2}
    true_rasters = {room.id: rasterise(room.polygon) for room in truth.rooms}
    pairs, ignored = [], set()
    for number, raster in rasters.items():
        z = float(rooms[number][:, 2].mean())
        for room in truth.rooms:
            above = z - room.z_floor
            same_storey = abs(above) <= options.storey_m
            if room.required and same_storey:
                pairs.append((intersection_over_union(raster, true_rasters[room.id]), number, room))
                continue
            within = same_storey or 0 < above < room.height_m  # a landing of a stairwell
            if not room.required and within:
                common = common_cells(raster, true_rasters[room.id])
                ignored |= {number} if common > 0.5 * raster.cells else set()
    score = Detection(true=len(required), error_names=_ROOM_ERRORS)
    near = [pair for pair in pairs if pair[0] >= options.room_iou]
    for iou, number, room in _once(near, lambda pair: (-pair[0], pair[1])):
        centroid = transform_points(truth_from_graph, graph.rooms[number].centroid[None])[0]
        away = float(np.linalg.norm(centroid[:2] - _area_centroid(room.polygon)))
        score.matches.append(Match(number, room.id, {"iou": iou, "centroid_m": away}))
    return _counted(score, graph.rooms, ignored)


def score_floors(
    graph: SceneGraph, truth: SceneTruth, truth_from_graph: Array, options: SceneOptions
) -> Detection:
    """Storeys, by the height of their ground; the nearest first, each matched once."""
    storeys = truth.storeys()
    required = {level for level, rooms in storeys.items() if any(room.required for room in rooms)}
    if "floors" not in graph.estimated:
        return not_estimated(len(required), _FLOOR_ERRORS)
    pairs, ignored = [], set()
    for floor in graph.floors.values():
        z = _floor_height(graph, floor, truth_from_graph)
        for level, rooms in storeys.items():
            away = min(abs(z - room.z_floor) for room in rooms)
            if away <= options.storey_m and level in required:
                pairs.append((away, floor.id, level))
            elif away <= options.storey_m:
                ignored.add(floor.id)
    score = Detection(true=len(required), error_names=_FLOOR_ERRORS)
    for away, number, level in _once(pairs, lambda pair: (pair[0], pair[1])):
        score.matches.append(Match(number, f"level {level}", {"height_m": away}))
    return _counted(score, graph.floors, ignored)


def score_doors(
    graph: SceneGraph, truth: SceneTruth, truth_from_graph: Array, options: SceneOptions, rooms: Detection
) -> Detection:
    """By the middle of the threshold, and the same two rooms after those were matched (`rooms`)."""
    required = sum(door.required for door in truth.doors)
    if "doors" not in graph.estimated:
        return not_estimated(required, _MIDDLE_ERRORS)
    true_name = {match.estimated: match.true for match in rooms.matches}
    pairs, ignored = [], set()
    for door in graph.doors.values():
        center = transform_points(truth_from_graph, door.center[None])[0]
        joined = frozenset(true_name.get(room) for room in door.rooms if room is not None)
        for true in truth.doors:
            away = float(np.linalg.norm((center - true.center)[:2]))
            if away > options.door_m or abs(center[2] - true.center[2]) > options.storey_m:
                continue
            if not true.required:
                ignored.add(door.id)
            elif joined == true.rooms:
                pairs.append((away, door.id, true.id))
    score = Detection(true=required, error_names=_MIDDLE_ERRORS)
    for away, number, name in _once(pairs, lambda pair: (pair[0], pair[1])):
        score.matches.append(Match(number, name, {"center_m": away}))
    return _counted(score, graph.doors, ignored)


def score_by_middle(
    kind: Kind[Any], graph: SceneGraph, truth: SceneTruth, truth_from_graph: Array
) -> Detection | None:
    """By the distance of the middles, the nearest first, each matched once; None: the truth lists none."""
    if kind.truth not in truth.elements:
        return None
    listed = truth.elements[kind.truth]
    required = sum(true.required for true in listed)
    if kind.section not in graph.estimated:
        return not_estimated(required, _MIDDLE_ERRORS)
    nodes = graph.section(kind.section)
    pairs, ignored = [], set()
    for number, node in nodes.items():
        center = transform_points(truth_from_graph, kind.place(node)[None])[0]
        for true in listed:
            away = float(np.linalg.norm(center - true.center))
            if away <= kind.within_m and true.required:
                pairs.append((away, number, true.id))
            elif away <= kind.within_m:
                ignored.add(number)
    score = Detection(true=required, error_names=_MIDDLE_ERRORS)
    for away, number, name in _once(pairs, lambda pair: (pair[0], pair[1])):
        score.matches.append(Match(number, name, {"center_m": away}))
    return _counted(score, nodes, ignored)


def _once(pairs: list[Any], rank: Any) -> list[Any]:
    """The pairs (score, estimated id, true entity) in order of rank, no side of which was taken before."""
    taken: list[Any] = []
    used: set[Any] = set()
    for pair in sorted(pairs, key=rank):
        ends = {("estimated", pair[1]), ("true", getattr(pair[2], "id", pair[2]))}
        if not ends & used:
            used |= ends
            taken.append(pair)
    return taken


def _counted(score: Detection, estimated: Iterable[int], ignored: set[int]) -> Detection:
    correct = {match.estimated for match in score.matches}
    score.correct = len(correct)
    score.ignored = len(ignored - correct)
    score.false = len(set(estimated) - correct - ignored)
    return score


def _outline(room: RoomNode, truth_from_graph: Array) -> Array:
    return transform_points(truth_from_graph, room.polygon)


def _floor_height(graph: SceneGraph, floor: FloorNode, truth_from_graph: Array) -> float:
    ground = graph.planes.get(floor.ground) if floor.ground is not None else None
    outlines = [graph.rooms[number].polygon for number in floor.rooms if len(graph.rooms[number].polygon)]
    if ground is not None:
        return float(transform_points(truth_from_graph, ground.centroid[None])[0, 2])
    points = np.concatenate(outlines) if outlines else floor.centroid[None]
    return float(transform_points(truth_from_graph, points)[:, 2].mean())


def _area_centroid(polygon: Array) -> Array:
    """(N, 2) -> (2,), of the area."""
    x, y = polygon.T
    x1, y1 = np.roll(polygon, -1, axis=0).T
    cross = x * y1 - x1 * y
    centroid: Array = np.array([((x + x1) * cross).sum(), ((y + y1) * cross).sum()]) / (3 * cross.sum())
    return centroid
