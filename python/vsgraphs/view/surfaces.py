"""Planes and rooms as triangles and lines for a viewer: plain arrays, z up."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vsgraphs.export.planes_ply import run_corners
from vsgraphs.scene_graph import (
    CLASS_COLOURS,
    Box,
    DoorNode,
    PlaneNode,
    RoomNode,
    SceneGraph,
    transform_points,
)
from vsgraphs.trajectory import Array

# Of rooms, in order of their ids; the same in plan and layered graph.
ROOM_COLOURS = (
    (239, 148, 62),
    (90, 180, 120),
    (96, 142, 220),
    (214, 96, 132),
    (180, 150, 60),
    (132, 112, 208),
    (70, 176, 190),
    (190, 118, 84),
)
_ALONG_EDGES = [0, 1, 2, 3, 0, 4, 5, 1, 5, 6, 2, 6, 7, 3, 7, 4]  # of a box's corners
AREA_SHADE = 0.62  # of a room's colour on the ground: large areas in full colour outshine all else


@dataclass
class Mesh:
    """vertices (V, 3) m, triangles (T, 3) indices, colours (V, 3) RGB."""

    vertices: Array
    triangles: npt.NDArray[np.int64]
    colours: npt.NDArray[np.uint8]


def upright(graph: SceneGraph) -> Array:
    """(4, 4): the graph's coordinates to ones with z up; a graph that is not levelled hangs on its camera."""
    if graph.frame.levelled:
        return np.eye(4)
    pose = np.eye(4)
    pose[:3, :3] = [[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]  # x where the first camera looked
    return pose


def room_colour(room: int) -> tuple[int, int, int]:
    """RGB of a room by its id."""
    return ROOM_COLOURS[room % len(ROOM_COLOURS)]


def plane_mesh(planes: Iterable[PlaneNode], up_from_graph: Array) -> Mesh:
    """The observed cells of the planes, coloured by class. Linear in runs of cells."""
    corners, colours = [np.zeros((0, 3))], [np.zeros((0, 3), np.uint8)]
    for plane in planes:
        quads = run_corners(plane.extent).reshape(-1, 3)
        corners.append(transform_points(up_from_graph, quads))
        colours.append(np.tile(np.array(CLASS_COLOURS[plane.role], np.uint8), (len(quads), 1)))
    vertices = np.concatenate(corners)
    first = 4 * np.arange(len(vertices) // 4)[:, None]
    triangles = (first[:, :, None] + np.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3)
    return Mesh(vertices, triangles, np.concatenate(colours))


def name_place(plane: PlaneNode, up_from_graph: Array) -> Array:
    """(3,) where a plane's name stands: a wall's upper rim, a corner of a ground, else the middle."""
    if plane.role == "ground" and len(plane.extent.polygon):
        corners = transform_points(up_from_graph, plane.extent.polygon)
        nearest: Array = corners[np.argmin(corners[:, 0] + corners[:, 1])]
        return nearest
    middle: Array = transform_points(up_from_graph, plane.centroid[None])[0]
    if plane.role == "wall" and len(plane.extent.polygon):
        middle[2] = transform_points(up_from_graph, plane.extent.polygon)[:, 2].max()
    return middle


def room_mesh(rooms: Iterable[RoomNode], up_from_graph: Array, above_m: float = 0.04) -> Mesh:
    """The rooms' areas, each in its colour, a little above the ground."""
    vertices, triangles, colours = (
        [np.zeros((0, 3))],
        [np.zeros((0, 3), np.int64)],
        [np.zeros((0, 3), np.uint8)],
    )
    start = 0
    for room in rooms:
        corners = transform_points(up_from_graph, room.polygon) + np.array([0.0, 0.0, above_m])
        vertices.append(corners)
        triangles.append(start + triangulate(corners[:, :2]))
        shade = (np.array(room_colour(room.id)) * AREA_SHADE).astype(np.uint8)
        colours.append(np.tile(shade, (len(corners), 1)))
        start += len(corners)
    return Mesh(np.concatenate(vertices), np.concatenate(triangles), np.concatenate(colours))


def room_place(room: RoomNode, up_from_graph: Array) -> Array:
    """(3,) a place well within the room, of an L too: the middle of its largest triangle."""
    corners = transform_points(up_from_graph, room.polygon)
    triangles = corners[triangulate(corners[:, :2])]
    if not len(triangles):
        middle: Array = transform_points(up_from_graph, room.centroid[None])[0]
        return middle
    sides = triangles[:, 1:] - triangles[:, :1]
    place: Array = triangles[np.argmax(np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1))].mean(
        axis=0
    )
    return place


def door_outline(door: DoorNode, up_from_graph: Array) -> Array:
    """(5, 3) the opening's rectangle, closed; where its height is unknown, 2 m."""
    centre = transform_points(up_from_graph, door.center[None])[0]
    normal = up_from_graph[:3, :3] @ door.normal
    along = np.cross([0.0, 0.0, 1.0], normal)
    along *= 0.5 * door.width_m / max(float(np.linalg.norm(along)), 1e-9)
    rise = np.array([0.0, 0.0, door.height_m or 2.0])
    return np.array(
        [centre - along, centre + along, centre + along + rise, centre - along + rise, centre - along]
    )


def box_outline(box: Box, up_from_graph: Array) -> Array:
    """(16, 3) one line along all twelve edges, some of them twice."""
    outline: Array = transform_points(up_from_graph, box.corners())[_ALONG_EDGES]
    return outline


def triangulate(polygon: Array) -> npt.NDArray[np.int64]:
    """(N, 2) corners of a simple polygon, either way round -> (T, 3) indices.

    By cutting ears (Meisters, "Polygons have ears", American Mathematical Monthly 1975). Corners of a polygon
    that crosses itself are cut as they come.
    """
    order = list(range(len(polygon)))
    if _doubled_area(polygon) < 0:
        order.reverse()
    triangles = []
    while len(order) > 2:
        ear = next((k for k in range(len(order)) if _is_ear(polygon, order, k)), 0)
        triangles.append((order[ear - 1], order[ear], order[(ear + 1) % len(order)]))
        del order[ear]
    return np.array(triangles, dtype=np.int64).reshape(-1, 3)


def _doubled_area(polygon: Array) -> float:
    x, y = polygon.T
    return float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def _is_ear(polygon: Array, order: list[int], k: int) -> bool:
    a, b, c = (polygon[order[k - 1]], polygon[order[k]], polygon[order[(k + 1) % len(order)]])
    if _side(a, b, c) <= 0:
        return False
    corners = {order[k - 1], order[k], order[(k + 1) % len(order)]}
    others = (polygon[i] for i in order if i not in corners)
    return not any(_side(a, b, p) >= 0 and _side(b, c, p) >= 0 and _side(c, a, p) >= 0 for p in others)


def _side(a: Array, b: Array, p: Array) -> float:
    return float((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]))
