"""A small building with its truth, and the map that a flawless run would make of it."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np

from vsgraphs.trajectory import Array

WALL_M = 0.12
HEIGHT_M = 2.6
DOOR_M = (0.9, 2.05)


def building() -> dict[str, Any]:
    """Two rooms side by side and a corridor along both, as scene_gt.json has them.

    The rooms' corridor walls are coplanar, so are the outer ones. A store room beside is scenery.
    """
    rooms = [
        _room("A", 0.0, 0.0, 4.0, 3.0),
        _room("B", 4.0 + WALL_M, 0.0, 8.0, 3.0),
        _room("C", 0.0, 3.0 + WALL_M, 8.0, 4.6, kind="corridor"),
        _room("S", 8.0 + WALL_M, 0.0, 10.0, 3.0, counted=False, visited=False),
    ]
    walls: list[dict[str, Any]] = []
    for room in rooms:
        corners = np.array(room["polygon"])
        for side, (p, q) in enumerate(zip(corners, np.roll(corners, -1, axis=0), strict=True)):
            along = (q - p) / np.linalg.norm(q - p)
            normal = np.array([-along[1], along[0]])
            room["walls"].append(len(walls))
            walls.append(
                {
                    "id": len(walls),
                    "room": room["id"],
                    "side": side,
                    "p0": [*p.tolist(), 0.0],
                    "p1": [*q.tolist(), 0.0],
                    "length": float(np.linalg.norm(q - p)),
                    "height": HEIGHT_M,
                    "n": [*normal.tolist(), 0.0],
                    "d": float(-normal @ p),
                    "counted": room["counted"],
                    "observed": True,
                }
            )
    doors = [
        _door(0, "A", "C", 2.0, 3.0 + WALL_M / 2, (0.0, 1.0, 0.0)),
        _door(1, "B", "C", 6.0, 3.0 + WALL_M / 2, (0.0, 1.0, 0.0)),
        _door(2, "B", "S", 8.0 + WALL_M / 2, 1.5, (1.0, 0.0, 0.0)),
    ]
    floors = [{"room": room["id"], "level": 0, "n": [0, 0, 1], "d": 0.0} for room in rooms]
    ceilings = [{"room": room["id"], "n": [0, 0, -1], "d": HEIGHT_M} for room in rooms]
    return {"rooms": rooms, "walls": walls, "floors": floors, "ceilings": ceilings, "doors": doors}


def _room(name: str, x0: float, y0: float, x1: float, y1: float, **more: Any) -> dict[str, Any]:
    return {
        "id": name,
        "polygon": [[x0, y0], [x1, y0], [x1, y1], [x0, y1]],
        "centroid": [(x0 + x1) / 2, (y0 + y1) / 2, 0.0],
        "area": (x1 - x0) * (y1 - y0),
        "level": 0,
        "z_floor": 0.0,
        "height": HEIGHT_M,
        "kind": "room",
        "counted": True,
        "visited": True,
        "walls": [],
        **more,
    }


def _door(number: int, a: str, b: str, x: float, y: float, normal: tuple[float, ...]) -> dict[str, Any]:
    return {
        "id": number,
        "rooms": [a, b],
        "center": [x, y, 0.0],
        "width": DOOR_M[0],
        "height": DOOR_M[1],
        "normal": list(normal),
    }


def camera_poses(truth: dict[str, Any], count: int = 12) -> Array:
    """(N, 4, 4) world_from_camera: a walk through the middles of the visited rooms, looking about."""
    middles = np.array([room["centroid"] for room in truth["rooms"] if room["visited"]])
    t = np.linspace(0, len(middles) - 1, count)
    poses = np.tile(np.eye(4), (count, 1, 1))
    for i in range(3):
        poses[:, i, 3] = np.interp(t, np.arange(len(middles)), middles[:, i])
    poses[:, 2, 3] += 1.3 + 0.05 * np.sin(5 * t)
    for pose, yaw, pitch in zip(poses, 0.4 + 2.3 * t, 0.1 * np.cos(t), strict=True):
        forward = np.array([np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)])
        right = np.array([np.sin(yaw), -np.cos(yaw), 0.0])
        pose[:3, :3] = np.stack([right, np.cross(forward, right), forward], axis=1)
    return poses


def perfect_map(truth: dict[str, Any], poses: Array) -> tuple[dict[str, Any], tuple[Array, Array, Array]]:
    """`snapshot.scene_graph()` and `snapshot.keyframes()` of a flawless run, in the first camera's frame."""
    ids: dict[Any, int] = {}
    everyone = list(range(len(poses)))
    planes = []
    for wall in truth["walls"]:
        ids["wall", wall["id"]] = len(planes)
        planes.append(_plane(len(planes), "wall", wall["n"], wall["d"], _wall_points(truth, wall), everyone))
    for floor, ceiling in zip(truth["floors"], truth["ceilings"], strict=True):
        room = next(r for r in truth["rooms"] if r["id"] == floor["room"])
        points = _floor_points(room)
        ground = ("ground", room["z_floor"])  # coplanar floors are one ground
        if ground in ids:
            planes[ids[ground]]["points"] = np.concatenate([planes[ids[ground]]["points"], points])
        else:
            ids[ground] = len(planes)
            planes.append(_plane(len(planes), "ground", floor["n"], floor["d"], points, everyone))
        above = points + np.array([0.0, 0.0, room["height"]])
        planes.append(_plane(len(planes), "ceiling", ceiling["n"], ceiling["d"], above, everyone[:1]))
    raw = {"up": np.array([0.0, 0.0, 1.0]), "planes": planes, **_structure(truth, ids)}
    return moved(raw, np.linalg.inv(poses[0])), (
        np.array(everyone, np.uint32),
        np.arange(len(poses)) * 0.5,
        np.linalg.inv(poses[0]) @ poses,
    )


def _structure(truth: dict[str, Any], ids: dict[Any, int]) -> dict[str, Any]:
    numbers = {room["id"]: i for i, room in enumerate(truth["rooms"])}
    levels = sorted({room["level"] for room in truth["rooms"]})
    rooms = [
        {
            "id": numbers[room["id"]],
            "name": room["id"],
            "kind": "corridor" if room["kind"] == "corridor" else "room",
            "walls": [ids["wall", number] for number in room["walls"]],
            "ground": ids["ground", room["z_floor"]],
            "polygon": np.array([[x, y, room["z_floor"]] for x, y in room["polygon"]]),
            "centroid": np.array(room["centroid"]),
            "height_m": room["height"],
            "area_m2": room["area"],
            "partial": False,
            "floor": levels.index(room["level"]),
        }
        for room in truth["rooms"]
    ]
    floors = [
        {
            "id": i,
            "rooms": [numbers[room["id"]] for room in truth["rooms"] if room["level"] == level],
            "ground": next(r["ground"] for r in rooms if r["floor"] == i),
            "centroid": np.mean(
                [room["centroid"] for room in truth["rooms"] if room["level"] == level], axis=0
            ),
        }
        for i, level in enumerate(levels)
    ]
    doors = [
        {
            "id": i,
            "rooms": [numbers[name] for name in door["rooms"]],
            "center": np.array(door["center"]),
            "width_m": door["width"],
            "height_m": door["height"],
            "normal": np.array(door["normal"], float),
            "kind": "door",
        }
        for i, door in enumerate(truth["doors"])
    ]
    places = [
        {
            "id": i,
            "position": np.array(room["centroid"]) + np.array([0, 0, 1.2]),
            "clearance_m": 0.8,
            "room": i,
            "neighbours": [j for j in range(len(rooms)) if abs(i - j) == 1],
        }
        for i, room in enumerate(truth["rooms"])
    ]
    marker = np.eye(4)
    marker[:3, 3] = [0.0, 1.0, 1.5]
    markers = [
        {
            "id": 17,
            "world_from_marker": marker,
            "size_m": 0.15,
            "name": "kitchen",
            "observed_by": [0, 1],
            "room": 0,
        }
    ]
    return {"rooms": rooms, "floors": floors, "doors": doors, "places": places, "markers": markers}


def _plane(
    number: int, role: str, normal: Any, d: float, points: Array, observed_by: list[int]
) -> dict[str, Any]:
    return {
        "id": number,
        "role": role,
        "votes": {role: 5.0},
        "normal": np.array(normal, float),
        "d": d,
        "anchor": points.mean(axis=0),
        "other_face": None,
        "thickness_m": None,
        "points": points,
        "observed_by": observed_by,
    }


def _wall_points(truth: dict[str, Any], wall: dict[str, Any], step: float = 0.05) -> Array:
    p0, p1 = np.array(wall["p0"]), np.array(wall["p1"])
    along = (p1 - p0) / wall["length"]
    u, v = np.meshgrid(
        np.arange(step / 2, wall["length"], step), np.arange(step / 2, wall["height"], step), indexing="ij"
    )
    u, v = u.ravel(), v.ravel()
    keep = np.ones(len(u), bool)
    for door in truth["doors"]:
        away = np.array(door["center"]) - p0
        if wall["room"] in door["rooms"] and abs(away @ np.array(wall["n"])) < 0.3:
            keep &= (np.abs(u - away @ along) > door["width"] / 2) | (v > door["height"])
    return p0 + u[keep, None] * along + v[keep, None] * np.array([0.0, 0.0, 1.0])


def _floor_points(room: dict[str, Any], step: float = 0.05) -> Array:
    from vsgraphs.scene_graph import inside_polygon

    polygon = np.array(room["polygon"])
    low, high = polygon.min(axis=0), polygon.max(axis=0)
    x, y = np.meshgrid(*(np.arange(a + step / 2, b, step) for a, b in zip(low, high, strict=True)))
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    points = points[inside_polygon(points, polygon)]
    return np.concatenate([points, np.full((len(points), 1), room["z_floor"])], axis=1)


def moved(raw: dict[str, Any], transform: Array) -> dict[str, Any]:
    """The same map after a rigid motion of everything."""
    out = copy.deepcopy(raw)
    rotation, shift = transform[:3, :3], transform[:3, 3]

    def points(row: dict[str, Any], *names: str) -> None:
        for name in names:
            row[name] = row[name] @ rotation.T + shift

    out["up"] = None if out["up"] is None else rotation @ out["up"]
    for plane in out["planes"]:
        plane["normal"] = rotation @ plane["normal"]
        plane["d"] = plane["d"] - plane["normal"] @ shift
        points(plane, "anchor", "points")
        plane["points"] = plane["points"].astype(np.float32)
    for row in out.get("rooms", ()):
        points(row, "polygon", "centroid")
    for row in out.get("floors", ()):
        points(row, "centroid")
    for row in out.get("doors", ()):
        points(row, "center")
        row["normal"] = rotation @ row["normal"]
    for row in out.get("places", ()):
        points(row, "position")
    for row in out.get("markers", ()):
        row["world_from_marker"] = transform @ row["world_from_marker"]
    return out
