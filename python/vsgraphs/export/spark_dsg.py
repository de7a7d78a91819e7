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
from itertools import pairwise

import numpy as np

from vsgraphs.export.spark_attributes import (
    UPRIGHT,
    Json,
    box_row,
    common_attributes,
    edge_row,
    layer_key,
    node_row,
    object_attributes,
    rotation_row,
    rounded,
    semantic_attributes,
    symbol,
    text_line,
)
from vsgraphs.scene_graph import CLASS_COLOURS, ROLES, Frame, PlaneNode, RoomNode, SceneGraph

_OBJECTS, _PLACES, _ROOMS, _BUILDINGS = 2, 3, 4, 5
_ROBOT = "a"
_NO_LABEL = 4294967295
_OBJECT_CLASSES = (*ROLES, "doorway", "marker")  # "door" is the plane of a closed leaf, "doorway" the opening
_ROOM_CLASSES = ("room", "corridor")
_FORMAT_VERSION = {"major": 1, "minor": 1, "patch": 3}


def format_spark_dsg(graph: SceneGraph) -> str:
    """The text of scene_graph.dsg.json, a node or edge per line."""
    nodes = [*_keyframes(graph), *_planes(graph), *_doors(graph), *_markers(graph)]
    nodes += [*_places(graph), *_rooms(graph), *_floors(graph)]
    layers = {"OBJECTS": _OBJECTS, "PLACES": _PLACES, "ROOMS": _ROOMS, "BUILDINGS": _BUILDINGS}
    keys = [
        layer_key(_OBJECTS),
        layer_key(_OBJECTS, ord(_ROBOT)),
        *(layer_key(n) for n in (_PLACES, _ROOMS, _BUILDINGS)),
    ]
    head = {
        "SPARK_DSG_header": {"project_name": "main", "version": _FORMAT_VERSION},
        "directed": False,
        "multigraph": False,
        "layer_keys": keys,
        "layer_names": {
            "AGENTS": layer_key(_OBJECTS),
            **{name: layer_key(layer) for name, layer in layers.items()},
        },
        "metadata": _metadata(graph.frame),
    }
    parts = [f"{json.dumps(name)}: {text_line(value)}" for name, value in head.items()]
    parts.append('"nodes": [\n' + ",\n".join(map(text_line, nodes)) + "\n]")
    parts.append('"edges": [\n' + ",\n".join(map(text_line, _edges(graph))) + "\n]")
    return "{\n" + ",\n".join(parts) + "\n}\n"


def _metadata(frame: Frame) -> Json:
    return {
        "labelspaces": {
            "_l2p0": [[i, name] for i, name in enumerate(_OBJECT_CLASSES)],
            "_l4p0": [[i, name] for i, name in enumerate(_ROOM_CLASSES)],
        },
        "vsgraphs": {"levelled": frame.levelled, "world_from_map": rounded(frame.world_from_map)},
    }


def _keyframes(graph: SceneGraph) -> list[Json]:
    rows = []
    for keyframe in graph.keyframes.values():
        attributes = {
            **common_attributes("AgentNodeAttributes", keyframe.world_from_camera[:3, 3]),
            "timestamp": round(keyframe.timestamp_s * 1e9),
            "world_R_body": rotation_row(keyframe.world_from_camera[:3, :3]),
            "external_key": keyframe.id,
            "dbow_ids": None,
            "dbow_values": None,
        }
        rows.append(node_row(_ROBOT, keyframe.id, _OBJECTS, attributes, ord(_ROBOT)))
    return rows


def _planes(graph: SceneGraph) -> list[Json]:
    rooms = {wall: room for room in graph.rooms.values() for wall in room.walls}
    return [
        node_row("O", plane.id, _OBJECTS, _plane_attributes(plane, rooms.get(plane.id)))
        for plane in graph.planes.values()
    ]


def _plane_attributes(plane: PlaneNode, room: RoomNode | None) -> Json:
    rotation = np.stack([plane.extent.axis_u, plane.extent.axis_v, plane.normal], axis=1)
    uv = plane.extent.flat(plane.extent.polygon)
    low, high = (uv.min(axis=0), uv.max(axis=0)) if len(uv) else (np.zeros(2), np.zeros(2))
    centre = plane.extent.lift((low + high)[None] / 2)[0] if len(uv) else plane.centroid
    box = box_row(centre, np.array([*(high - low), 0.0]), rotation)
    details = {
        "plane": rounded(np.array([*plane.normal, plane.offset_m])),
        "polygon": rounded(plane.extent.polygon),
        "area_m2": rounded(plane.area_m2),
        "other_face": plane.other_face,
        "thickness_m": None if plane.thickness_m is None else rounded(plane.thickness_m),
        "observed_by": plane.observed_by,
    }
    name = f"{plane.role} {plane.id}" + (f" of {room.name}" if room is not None and room.name else "")
    colour = CLASS_COLOURS[plane.role]
    attributes = object_attributes(name, plane.centroid, ROLES.index(plane.role), colour, details)
    return {**attributes, "bounding_box": box}


def _doors(graph: SceneGraph) -> list[Json]:
    rows = []
    for door in graph.doors.values():
        details = {
            "rooms": list(door.rooms),
            "width_m": rounded(door.width_m),
            "height_m": None if door.height_m is None else rounded(door.height_m),
            "normal": rounded(door.normal),
            "kind": door.kind,
        }
        label = _OBJECT_CLASSES.index("doorway")
        attributes = object_attributes(
            door.name or f"{door.kind} {door.id}", door.center, label, CLASS_COLOURS["door"], details=details
        )
        rows.append(node_row("D", door.id, _OBJECTS, attributes))
    return rows


def _markers(graph: SceneGraph) -> list[Json]:
    rows = []
    for marker in graph.markers.values():
        details = {
            "aruco_id": marker.id,
            "size_m": rounded(marker.size_m),
            "observed_by": marker.observed_by,
            "room": marker.room,
            "door": marker.door,
        }
        name, label = marker.name or f"marker {marker.id}", _OBJECT_CLASSES.index("marker")
        position = marker.world_from_marker[:3, 3]
        attributes = object_attributes(name, position, label, (220, 60, 60), details)
        attributes["world_R_object"] = rotation_row(marker.world_from_marker[:3, :3])
        rows.append(node_row("M", marker.id, _OBJECTS, attributes))
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
        "orientation": UPRIGHT,
        "pcl_mesh_connections": [],
        "real_place": True,
        "voxblox_mesh_connections": [],
    }
    rows = []
    for place in graph.places.values():
        semantic = semantic_attributes("PlaceNodeAttributes", "", place.position, _NO_LABEL, (90, 90, 90))
        rows.append(
            node_row("p", place.id, _PLACES, {**semantic, **extra, "distance": rounded(place.clearance_m)})
        )
    return rows


def _rooms(graph: SceneGraph) -> list[Json]:
    rows = []
    for room in graph.rooms.values():
        details = {
            "kind": room.kind,
            "polygon": rounded(room.polygon),
            "area_m2": rounded(room.area_m2),
            "height_m": None if room.height_m is None else rounded(room.height_m),
            "walls": room.walls,
            "ground": room.ground,
            "partial": room.partial,
        }
        low, high = room.polygon.min(axis=0), room.polygon.max(axis=0)
        if room.height_m is not None:
            high = high + np.array([0.0, 0.0, room.height_m])
        label = _ROOM_CLASSES.index(room.kind)
        attributes = semantic_attributes(
            "RoomNodeAttributes", room.name or f"room {room.id}", room.centroid, label, (140, 180, 220)
        )
        attributes |= {"metadata": details, "bounding_box": box_row((low + high) / 2, high - low)}
        rows.append(node_row("R", room.id, _ROOMS, {**attributes, "semantic_class_probabilities": {}}))
    return rows


def _floors(graph: SceneGraph) -> list[Json]:
    rows = []
    for floor in graph.floors.values():
        attributes = semantic_attributes(
            "RoomNodeAttributes", f"floor {floor.id}", floor.centroid, _NO_LABEL, (220, 200, 140)
        )
        attributes |= {"metadata": {"ground": floor.ground}, "semantic_class_probabilities": {}}
        rows.append(node_row("B", floor.id, _BUILDINGS, attributes))
    return rows


def _edges(graph: SceneGraph) -> list[Json]:
    edges = [edge_row(symbol(_ROBOT, a), symbol(_ROBOT, b)) for a, b in pairwise(graph.keyframes)]
    for place in graph.places.values():
        edges += [edge_row(symbol("p", place.id), symbol("p", o)) for o in place.neighbours if o > place.id]
    edges += [edge_row(parent, child) for child, parent in sorted(_parents(graph).items())]
    joined: dict[tuple[int, int], list[int]] = {}
    for door in graph.doors.values():
        first, second = door.rooms
        if first is not None and second is not None:
            joined.setdefault((min(first, second), max(first, second)), []).append(door.id)
    return edges + [
        edge_row(symbol("R", a), symbol("R", b), {"doors": doors}) for (a, b), doors in sorted(joined.items())
    ]


def _parents(graph: SceneGraph) -> dict[int, int]:
    """Child -> its one parent, as spark-dsg has it: a wall that bounds two rooms is under the first."""
    parents: dict[int, int] = {}
    for room in graph.rooms.values():
        for number in [*room.walls, *([] if room.ground is None else [room.ground])]:
            parents.setdefault(symbol("O", number), symbol("R", room.id))
        if room.floor is not None:
            parents[symbol("R", room.id)] = symbol("B", room.floor)
    for door in graph.doors.values():
        room_of_door = next((room for room in door.rooms if room is not None), None)
        if room_of_door is not None:
            parents[symbol("D", door.id)] = symbol("R", room_of_door)
    for prefix, nodes in (("M", graph.markers), ("p", graph.places)):
        for node in nodes.values():
            if node.room is not None:
                parents[symbol(prefix, node.id)] = symbol("R", node.room)
    return parents
