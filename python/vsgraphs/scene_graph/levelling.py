"""A frame that people and robots expect: z up, x forward, the ground at zero (REP-103)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from vsgraphs.scene_graph.frame import Frame
from vsgraphs.trajectory import Array

# A ground seen this near to the plumb line through the first camera is the one the camera was carried over.
_UNDER_CAMERA_M = 3.0


def level(up: Array | None, planes: Sequence[Mapping[str, Any]], first_camera: Array) -> Frame:
    """The levelled frame of a map; the map's own where `up` is None.

    up: (3,) against gravity, in the map. planes: the map's raw planes. first_camera: (4, 4)
    world_from_camera of the first keyframe, in the map. z = 0 is where the plumb line through the first
    camera meets the ground: of the ground planes below that camera the one most observed, those seen within
    3 m of the plumb line before others.
    """
    if up is None:
        return Frame()
    z = np.asarray(up, dtype=np.float64) / np.linalg.norm(up)
    x = _heading(z, first_camera)
    rotation = np.stack([x, np.cross(z, x), z])
    camera = first_camera[:3, 3]
    ground = _ground_under(camera, z, planes)
    height = 0.0 if ground is None else _height_above(camera, z, ground)
    world_from_map = np.eye(4)
    world_from_map[:3, :3] = rotation
    world_from_map[:3, 3] = np.array([0.0, 0.0, height]) - rotation @ camera
    return Frame(True, world_from_map, None if ground is None else int(ground["id"]))


def transform_poses(world_from_map: Array, poses: Array) -> Array:
    """(N, 4, 4) poses map_from_x -> world_from_x. Rotations stay orthonormal to rounding."""
    moved: Array = world_from_map @ poses if len(poses) else np.zeros((0, 4, 4))
    return moved


def transform_points(world_from_map: Array, points: Array) -> Array:
    """(N, 3) map points -> the graph's frame."""
    moved: Array = np.asarray(points, dtype=np.float64) @ world_from_map[:3, :3].T + world_from_map[:3, 3]
    return moved


def transform_plane(world_from_map: Array, normal: Array, offset_m: float) -> tuple[Array, float]:
    """A plane normal . x + offset = 0 under the transform."""
    moved = world_from_map[:3, :3] @ normal
    return moved, float(offset_m - moved @ world_from_map[:3, 3])


def _heading(z: Array, first_camera: Array) -> Array:
    """Horizontal viewing direction; of a camera that looks straight up or down, where its image's top (or
    bottom) points.
    """
    forward, image_up = first_camera[:3, 2], -first_camera[:3, 1]
    for direction in (forward, -np.sign(forward @ z) * image_up):
        flat = direction - z * float(direction @ z)
        if np.linalg.norm(flat) > 0.05:
            heading: Array = flat / np.linalg.norm(flat)
            return heading
    raise AssertionError("a camera's z and y cannot both be vertical")


def _ground_under(camera: Array, z: Array, planes: Sequence[Mapping[str, Any]]) -> Mapping[str, Any] | None:
    below = [
        plane
        for plane in planes
        if plane["role"] == "ground"
        and float(np.asarray(plane["normal"]) @ z) > 0.5
        and _height_above(camera, z, plane) > 0.0
    ]
    near = [plane for plane in below if _plumb_distance(camera, z, plane) < _UNDER_CAMERA_M]
    ordered = sorted(
        near or below, key=lambda p: (-len(p.get("observed_by", ())), -len(p.get("points", ())), p["id"])
    )
    return ordered[0] if ordered else None


def _height_above(camera: Array, z: Array, plane: Mapping[str, Any]) -> float:
    """How far the plumb line from the camera runs down to the plane."""
    normal = np.asarray(plane["normal"], dtype=np.float64)
    return float((normal @ camera + plane["d"]) / (normal @ z))


def _plumb_distance(camera: Array, z: Array, plane: Mapping[str, Any]) -> float:
    points = np.asarray(plane.get("points", ()), dtype=np.float64).reshape(-1, 3)
    if not len(points):
        points = np.asarray(plane["anchor"], dtype=np.float64).reshape(1, 3)
    away = points - camera
    return float(np.linalg.norm(away - np.outer(away @ z, z), axis=1).min())
