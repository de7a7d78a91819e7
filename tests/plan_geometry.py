"""Plane geometry of plans given as nested dicts: what stands where, and what is in whose way."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np

Polygon = np.ndarray  # (n, 2), convex, m
Plan = dict[str, Any]


def footprint(box: dict[str, Any]) -> Polygon:
    """Of furniture."""
    yaw = math.radians(box.get("yaw_deg", 0))
    turn = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * np.array(box["size"][:2]) / 2
    return corners @ turn.T + np.array(box["at"])


def distance(a: Polygon, b: Polygon) -> float:
    """Between convex polygons, negative where they overlap. A segment is one."""
    reach = sum(float(np.linalg.norm(p - p.mean(axis=0), axis=1).max()) for p in (a, b))
    middles = float(np.linalg.norm(a.mean(axis=0) - b.mean(axis=0)))
    if middles > reach + 1:  # far apart: a lower bound will do
        return middles - reach
    best = -math.inf
    for corners in (a, b):
        edges = np.roll(corners, -1, axis=0) - corners
        normals = np.column_stack([edges[:, 1], -edges[:, 0]])
        lengths = np.linalg.norm(normals, axis=1)
        normals = normals[lengths > 1e-12] / lengths[lengths > 1e-12, None]
        pa, pb = normals @ a.T, normals @ b.T
        gaps = np.maximum(pb.min(axis=1) - pa.max(axis=1), pa.min(axis=1) - pb.max(axis=1))
        best = max(best, float(gaps.max(initial=-math.inf)))
    if best < 0:
        return best
    return min(_corners_to_edges(a, b), _corners_to_edges(b, a))


def _corners_to_edges(points: np.ndarray, polygon: Polygon) -> float:
    starts = polygon[:, None]
    edges = np.roll(polygon, -1, axis=0)[:, None] - starts
    squared = np.maximum((edges**2).sum(axis=2), 1e-24)
    share = np.clip(((points[None] - starts) * edges).sum(axis=2) / squared, 0, 1)
    return float(np.linalg.norm(points[None] - starts - share[..., None] * edges, axis=2).min())


def inside(point: np.ndarray, polygon: Polygon, margin: float = 0.0) -> bool:
    """Whether a counter-clockwise convex polygon holds the point, `margin` away from its edges."""
    edges = np.roll(polygon, -1, axis=0) - polygon
    left = np.column_stack([-edges[:, 1], edges[:, 0]]) / np.linalg.norm(edges, axis=1)[:, None]
    return bool((((point - polygon) * left).sum(axis=1) >= margin - 1e-6).all())


def outline(room: dict[str, Any]) -> Polygon:
    """Of a room."""
    return np.array(room["polygon"], dtype=float)


def heights(room: dict[str, Any]) -> tuple[float, float]:
    """Floor and ceiling."""
    floor = room.get("z_floor", 0.0)
    return floor, floor + room.get("height", 2.6)


def walls_of_doors(plan: Plan) -> Iterator[tuple[dict[str, Any], str, np.ndarray, np.ndarray]]:
    """Each door with each of its rooms: door, room, direction along the wall, direction into the room."""
    rooms = {room["id"]: room for room in plan["rooms"]}
    for door in plan["doors"]:
        at = np.array(door["at"])
        for name in door["rooms"]:
            corners = outline(rooms[name])
            edges = np.roll(corners, -1, axis=0) - corners
            along = edges / np.linalg.norm(edges, axis=1)[:, None]
            into = np.column_stack([-along[:, 1], along[:, 0]])
            on_wall = ((at - corners) * along).sum(axis=1)
            lengths = np.linalg.norm(edges, axis=1)
            away = np.abs(((at - corners) * into).sum(axis=1)) + 10 * ((on_wall < 0) | (on_wall > lengths))
            wall = int(away.argmin())
            yield door, name, along[wall], into[wall]


def place_on_wall(room: dict[str, Any], item: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """Ends of a picture or window on the floor plan."""
    corners = outline(room)
    a, b = corners[item["wall"]], corners[(item["wall"] + 1) % len(corners)]
    along = (b - a) / np.linalg.norm(b - a)
    half = item.get("width", 1.4) / 2
    return a + (item["along"] - half) * along, a + (item["along"] + half) * along


def local(room: dict[str, Any], point: Any) -> tuple[float, float]:
    """A point from the room's first corner, x along its first wall; to the millimetre."""
    corners = outline(room)
    along = (corners[1] - corners[0]) / np.linalg.norm(corners[1] - corners[0])
    d = np.array(point) - corners[0]
    x, y = float(d @ along), float(d @ np.array([-along[1], along[0]]))
    return round(x, 3) + 0.0, round(y, 3) + 0.0


def headings_deg(points: list[dict[str, Any]]) -> list[float]:
    """Where way-points with `look` look."""
    return [
        math.degrees(math.atan2(p["look"][1] - p["at"][1], p["look"][0] - p["at"][0]))
        for p in points
        if "look" in p
    ]


def turned_deg(headings: list[float]) -> float:
    """How far one turns from heading to heading, the shorter way each time."""
    return sum(abs(math.remainder(b - a, 360)) for a, b in pairwise(headings))
