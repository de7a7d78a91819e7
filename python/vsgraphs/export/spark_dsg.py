"""scene_graph.dsg.json: the JSON that the package spark-dsg loads.

Hughes, Chang and Carlone, "Hydra: a real-time spatial perception system for 3D scene graph construction and
optimization", RSS 2022. Written from the format the package itself saves (header version 1.1.3); the package
is not needed to write it.

Layers: floors in BUILDINGS, rooms in ROOMS, places in PLACES, planes, doors and markers in OBJECTS (labelled
by the graph's label space), keyframes as agents of robot "a". What spark-dsg has no field for is in each
node's `metadata`.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from vsgraphs.scene_graph import CLASS_COLOURS, ROLES, Frame, PlaneNode, RoomNode, SceneGraph
from vsgraphs.trajectory import Array, quaternions_from_rotations

_OBJECTS, _PLACES, _ROOMS, _BUILDINGS = 2, 3, 4, 5
_ROBOT = "a"
_NO_LABEL = 4294967295
_OBJECT_CLASSES = (*ROLES, "doorway", "marker")  # "door" is the plane of a closed leaf, "doorway" the opening
_ROOM_CLASSES = ("room", "corridor")
_FORMAT_VERSION = {"major": 1, "minor": 1, "patch": 3}
_FEATURE = {"cols": 0, "data": None, "rows": 0}
_UPRIGHT = {"w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0}

Json = dict[str, Any]


def format_spark_dsg(graph: SceneGraph) -> str:
    """The text of scene_graph.dsg.json, a node or edge per line."""
    nodes = [*_keyframes(graph), *_planes(graph), *_doors(graph), *_markers(graph)]
    nodes += [*_places(graph), *_rooms(graph), *_floors(graph)]
    layers = {"OBJECTS": _OBJECTS, "PLACES": _PLACES, "ROOMS": _ROOMS, "BUILDINGS": _BUILDINGS}
    keys = [_key(_OBJECTS), _key(_OBJECTS, ord(_ROBOT)), *(_key(n) for n in (_PLACES, _ROOMS, _BUILDINGS))]
    head = {
        "SPARK_DSG_header": {"project_name": "main", "version": _FORMAT_VERSION},
        "directed": False,
        "multigraph": False,
        "layer_keys": keys,
        "layer_names": {"AGENTS": _key(_OBJECTS), **{name: _key(layer) for name, layer in layers.items()}},
        "metadata": _metadata(graph.frame),
    }
    parts = [f"{json.dumps(name)}: {_line(value)}" for name, value in head.items()]
    parts.append('"nodes": [\n' + ",\n".join(map(_line, nodes)) + "\n]")
    parts.append('"edges": [\n' + ",\n".join(map(_line, _edges(graph))) + "\n]")
    return "{\n" + ",\n".join(parts) + "\n}\n"


def symbol(prefix: str, number: int) -> int:
    """A spark-dsg node id: the letter in the highest byte."""
    return (ord(prefix) << 56) | number


def _metadata(frame: Frame) -> Json:
    return {
        "labelspaces": {
            "_l2p0": [[i, name] for i, name in enumerate(_OBJECT_CLASSES)],
            "_l4p0": [[i, name] for i, name in enumerate(_ROOM_CLASSES)],
        },
        "vsgraphs": {"levelled": frame.levelled, "world_from_map": _rounded(frame.world_from_map)},
    }


def _keyframes(graph: SceneGraph) -> list[Json]:
    rotations = np.array([k.world_from_camera[:3, :3] for k in graph.keyframes.values()]).reshape(-1, 3, 3)
    quaternions = quaternions_from_rotations(rotations) if len(rotations) else np.zeros((0, 4))
    rows = []
    for keyframe, q in zip(graph.keyframes.values(), quaternions, strict=True):
        attributes = {
            **_common("AgentNodeAttributes", keyframe.world_from_camera[:3, 3]),
            "timestamp": round(keyframe.timestamp_s * 1e9),
            "world_R_body": _quaternion(q),
            "external_key": keyframe.id,
            "dbow_ids": None,
            "dbow_values": None,
        }
        rows.append(_node(_ROBOT, keyframe.id, _OBJECTS, attributes, ord(_ROBOT)))
    return rows


def _planes(graph: SceneGraph) -> list[Json]:
    rooms = {wall: room for room in graph.rooms.values() for wall in room.walls}
    return [
        _node("O", plane.id, _OBJECTS, _plane_attributes(plane, rooms.get(plane.id)))
        for plane in graph.planes.values()
    ]


def _plane_attributes(plane: PlaneNode, room: RoomNode | None) -> Json:
    rotation = np.stack([plane.extent.axis_u, plane.extent.axis_v, plane.normal], axis=1)
    uv = plane.extent.flat(plane.extent.polygon)
    low, high = (uv.min(axis=0), uv.max(axis=0)) if len(uv) else (np.zeros(2), np.zeros(2))
    centre = plane.extent.lift((low + high)[None] / 2)[0] if len(uv) else plane.centroid
    box = _box(centre, np.array([*(high - low), 0.0]), rotation)
    details = {
        "plane": _rounded(np.array([*plane.normal, plane.offset_m])),
        "polygon": _rounded(plane.extent.polygon),
        "area_m2": _rounded(plane.area_m2),
        "other_face": plane.other_face,
        "thickness_m": None if plane.thickness_m is None else _rounded(plane.thickness_m),
        "observed_by": plane.observed_by,
    }
    name = f"{plane.role} {plane.id}" + (f" of {room.name}" if room is not None and room.name else "")
    colour = CLASS_COLOURS[plane.role]
    return _object(name, plane.centroid, ROLES.index(plane.role), colour, box=box, details=details)


def _doors(graph: SceneGraph) -> list[Json]:
    rows = []
    for door in graph.doors.values():
        details = {
            "rooms": list(door.rooms),
            "width_m": _rounded(door.width_m),
            "height_m": None if door.height_m is None else _rounded(door.height_m),
            "normal": _rounded(door.normal),
            "kind": door.kind,
        }
        label = _OBJECT_CLASSES.index("doorway")
        attributes = _object(
            f"{door.kind} {door.id}", door.center, label, CLASS_COLOURS["door"], details=details
        )
        rows.append(_node("D", door.id, _OBJECTS, attributes))
    return rows


def _markers(graph: SceneGraph) -> list[Json]:
    rows = []
    for marker in graph.markers.values():
        details = {
            "aruco_id": marker.id,
            "size_m": _rounded(marker.size_m),
            "observed_by": marker.observed_by,
        }
        name, label = marker.name or f"marker {marker.id}", _OBJECT_CLASSES.index("marker")
        position = marker.world_from_marker[:3, 3]
        attributes = _object(name, position, label, (220, 60, 60), details=details)
        attributes["world_R_object"] = _rotation(marker.world_from_marker[:3, :3])
        rows.append(_node("M", marker.id, _OBJECTS, attributes))
    return rows


def _places(graph: SceneGraph) -> list[Json]:
    extra: Json = {
        "active_frontier": False,
        "anti_frontier": False,
        "deformation_connections": [],
        "frontier_scale": [0.0, 0.0, 0.0],
        "mesh_vertex_labels": [],
        "need_cleanup": False,
        "num_basis_points": 0,
        "num_frontier_voxels": 0,
        "orientation": _UPRIGHT,
        "pcl_mesh_connections": [],
        "real_place": True,
        "voxblox_mesh_connections": [],
    }
    rows = []
    for place in graph.places.values():
        semantic = _semantic("PlaceNodeAttributes", "", place.position, _NO_LABEL, (90, 90, 90))
        rows.append(
            _node("p", place.id, _PLACES, {**semantic, **extra, "distance": _rounded(place.clearance_m)})
        )
    return rows


def _rooms(graph: SceneGraph) -> list[Json]:
    rows = []
    for room in graph.rooms.values():
        details = {
            "kind": room.kind,
            "polygon": _rounded(room.polygon),
            "area_m2": _rounded(room.area_m2),
            "height_m": None if room.height_m is None else _rounded(room.height_m),
            "walls": room.walls,
            "ground": room.ground,
            "partial": room.partial,
        }
        low, high = room.polygon.min(axis=0), room.polygon.max(axis=0)
        if room.height_m is not None:
            high = high + np.array([0.0, 0.0, room.height_m])
        label = _ROOM_CLASSES.index(room.kind)
        attributes = _semantic(
            "RoomNodeAttributes", room.name or f"room {room.id}", room.centroid, label, (140, 180, 220)
        )
        attributes |= {"metadata": details, "bounding_box": _box((low + high) / 2, high - low)}
        rows.append(_node("R", room.id, _ROOMS, {**attributes, "semantic_class_probabilities": {}}))
    return rows


def _floors(graph: SceneGraph) -> list[Json]:
    rows = []
    for floor in graph.floors.values():
        attributes = _semantic(
            "RoomNodeAttributes", f"floor {floor.id}", floor.centroid, _NO_LABEL, (220, 200, 140)
        )
        attributes |= {"metadata": {"ground": floor.ground}, "semantic_class_probabilities": {}}
        rows.append(_node("B", floor.id, _BUILDINGS, attributes))
    return rows


def _edges(graph: SceneGraph) -> list[Json]:
    """A child has one parent: a wall that bounds two rooms is under the first; `walls` of both name it."""
    edges = []
    keyframes = list(graph.keyframes)
    edges += [
        _edge(symbol(_ROBOT, a), symbol(_ROBOT, b)) for a, b in zip(keyframes, keyframes[1:], strict=False)
    ]
    for place in graph.places.values():
        edges += [_edge(symbol("p", place.id), symbol("p", o)) for o in place.neighbours if o > place.id]
        if place.room is not None:
            edges.append(_edge(symbol("R", place.room), symbol("p", place.id)))
    parents: dict[int, int] = {}
    for room in graph.rooms.values():
        below = [("O", number) for number in room.walls]
        below += [("O", room.ground)] if room.ground is not None else []
        for prefix, number in below:
            parents.setdefault(symbol(prefix, number), symbol("R", room.id))
        if room.floor is not None:
            edges.append(_edge(symbol("B", room.floor), symbol("R", room.id)))
    for door in graph.doors.values():
        if door.rooms[0] is not None:
            parents[symbol("D", door.id)] = symbol("R", door.rooms[0])
    for marker in graph.markers.values():
        if marker.room is not None:
            parents[symbol("M", marker.id)] = symbol("R", marker.room)
    edges += [_edge(parent, child) for child, parent in sorted(parents.items())]
    joined: dict[tuple[int, int], list[int]] = {}
    for door in graph.doors.values():
        first, second = door.rooms
        if first is not None and second is not None:
            joined.setdefault((min(first, second), max(first, second)), []).append(door.id)
    return edges + [
        _edge(symbol("R", a), symbol("R", b), {"doors": doors}) for (a, b), doors in sorted(joined.items())
    ]


def _edge(source: int, target: int, metadata: Json | None = None) -> Json:
    info = {"type": "EdgeAttributes", "weight": 1.0, "weighted": False, "metadata": metadata or {}}
    return {"source": source, "target": target, "info": info}


def _node(prefix: str, number: int, layer: int, attributes: Json, partition: int = 0) -> Json:
    return {"id": symbol(prefix, number), **_key(layer, partition), "attributes": attributes}


def _key(layer: int, partition: int = 0) -> Json:
    return {"layer": layer, "partition": partition}


def _common(kind: str, position: Array) -> Json:
    return {
        "type": kind,
        "position": _rounded(position),
        "last_update_time_ns": 0,
        "is_active": False,
        "is_predicted": False,
        "metadata": {},
    }


def _semantic(kind: str, name: str, position: Array, label: int, rgb: tuple[int, int, int]) -> Json:
    return {
        **_common(kind, position),
        "name": name,
        "color": {**dict(zip("rgb", rgb, strict=True)), "a": 255},
        "bounding_box": _box(np.zeros(3), np.zeros(3), None, "INVALID"),
        "semantic_label": label,
        "semantic_feature": _FEATURE,
    }


def _object(
    name: str,
    position: Array,
    label: int,
    rgb: tuple[int, int, int],
    *,
    details: Json,
    box: Json | None = None,
) -> Json:
    attributes = _semantic("ObjectNodeAttributes", name, position, label, rgb)
    attributes |= {
        "metadata": details,
        "mesh_connections": [],
        "registered": True,
        "world_R_object": _UPRIGHT,
    }
    return attributes if box is None else {**attributes, "bounding_box": box}


def _box(centre: Array, size: Array, rotation: Array | None = None, kind: str | None = None) -> Json:
    return {
        "type": kind or ("AABB" if rotation is None else "OBB"),
        "dimensions": _rounded(size),
        "world_P_center": _rounded(centre),
        "world_R_center": _UPRIGHT if rotation is None else _rotation(rotation),
    }


def _rotation(rotation: Array) -> Json:
    return _quaternion(quaternions_from_rotations(rotation[None])[0])


def _quaternion(xyzw: Array) -> Json:
    return dict(zip("xyzw", _rounded(xyzw), strict=True))


def _rounded(value: Array | float) -> Any:
    return (np.round(np.asarray(value, dtype=np.float64), 9) + 0.0).tolist()


def _line(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False, separators=(", ", ": "), allow_nan=False)
