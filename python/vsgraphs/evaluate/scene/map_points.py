"""How exactly map points lie on the true walls, floors and ceilings."""

from __future__ import annotations

import numpy as np

from vsgraphs.evaluate.scene.options import SceneOptions
from vsgraphs.evaluate.scene.scores import MapScore
from vsgraphs.evaluate.scene.truth import SceneTruth, TrueRoom, TrueWall
from vsgraphs.scene_graph import inside_polygon
from vsgraphs.trajectory import Array


def score_map(points: Array, truth: SceneTruth, options: SceneOptions) -> MapScore | None:
    """(M, 3) map points in the truth's frame; None without points. Cost M times the number of surfaces."""
    points = points[np.isfinite(points).all(axis=1)]
    if not len(points):
        return None
    distance = structural_distance(points, truth)
    near = distance[distance <= options.near_m]
    return MapScore(
        points=len(points),
        rmse_m=_rms(distance),
        median_m=float(np.median(distance)),
        near_m=options.near_m,
        structural_points=len(near),
        structural_rmse_m=_rms(near) if len(near) else None,
        within_m=options.within_m,
        share_within=float(np.mean(distance <= options.within_m)),
    )


def structural_distance(points: Array, truth: SceneTruth) -> Array:
    """(M, 3) -> (M,) distance to the nearest wall, floor or ceiling of any room, scored or not.

    Openings count as wall: where they are is for the doors' score.
    """
    distance = np.full(len(points), np.inf)
    for wall in truth.walls:
        np.minimum(distance, _to_wall(points, wall), out=distance)
    for room in truth.rooms:
        np.minimum(distance, _to_slabs(points, room), out=distance)
    return distance


def _to_wall(points: Array, wall: TrueWall) -> Array:
    away = points - wall.start
    along, up = away @ wall.along, away[:, 2]
    beside = along - np.clip(along, 0.0, wall.length_m)
    above = up - np.clip(up, 0.0, wall.height_m)
    distance: Array = np.sqrt((away @ wall.normal) ** 2 + beside**2 + above**2)
    return distance


def _to_slabs(points: Array, room: TrueRoom) -> Array:
    """To the floor or the ceiling."""
    beside = np.where(
        inside_polygon(points[:, :2], room.polygon), 0.0, _to_outline(points[:, :2], room.polygon)
    )
    vertical = np.minimum(
        np.abs(points[:, 2] - room.z_floor), np.abs(points[:, 2] - room.z_floor - room.height_m)
    )
    distance: Array = np.hypot(beside, vertical)
    return distance


def _to_outline(points: Array, polygon: Array) -> Array:
    distance = np.full(len(points), np.inf)
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        side = b - a
        t = np.clip((points - a) @ side / max(float(side @ side), 1e-12), 0.0, 1.0)
        np.minimum(distance, np.linalg.norm(points - a - t[:, None] * side, axis=1), out=distance)
    return distance


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
