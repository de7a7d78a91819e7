"""What stands on which storey of the plan."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from vsgraphs.export.floorplan.strips import Strip, cut_doors, join_corners, strips_of
from vsgraphs.export.floorplan.view import PlanView
from vsgraphs.scene_graph import KINDS, Box, DoorNode, Kind, MarkerNode, PlaneNode, RoomNode, SceneGraph
from vsgraphs.trajectory import Array

_APART_M = 1.5  # grounds nearer in height are steps of one storey
_BELOW_M = 0.5


@dataclass(eq=False)
class Storey:
    """floor_m, top_m: heights along up between which it lies. boxes: what is drawn as a box, with its kind.
    path: stretches of (N, 2) places walked; start, end: of the whole path, where it begins or ends here.
    """

    floor_m: float
    top_m: float
    strips: list[Strip] = field(default_factory=list)
    rooms: list[RoomNode] = field(default_factory=list)
    doors: list[DoorNode] = field(default_factory=list)
    markers: list[MarkerNode] = field(default_factory=list)
    grounds: list[PlaneNode] = field(default_factory=list)
    boxes: list[tuple[Kind[Any], Box]] = field(default_factory=list)
    path: list[Array] = field(default_factory=list)
    start: Array | None = None
    end: Array | None = None

    def holds(self, height: float) -> bool:
        """Whether something at this height belongs here."""
        return self.floor_m - _BELOW_M <= height < self.top_m - _BELOW_M


def storeys_of(graph: SceneGraph, view: PlanView, positions: Array) -> list[Storey]:
    """From the lowest up. positions: (N, 3) camera centres in the graph's frame, in order of time."""
    floors = _floor_heights(graph, view)
    storeys = [Storey(low, high) for low, high in zip(floors, [*floors[1:], np.inf], strict=True)]
    for storey in storeys:
        storey.rooms = [r for r in graph.rooms.values() if storey.holds(_room_height(r, view))]
        storey.doors = [d for d in graph.doors.values() if storey.holds(_height(d.center, view))]
        storey.grounds = [
            p
            for p in graph.planes_of("ground")
            if len(p.extent.runs) and storey.holds(_height(p.centroid, view))
        ]
        storey.markers = [
            m for m in graph.markers.values() if storey.holds(_height(m.world_from_marker[:3, 3], view))
        ]
        storey.boxes = list(_boxes(graph, storey, view))
        walls = [s for p in graph.planes_of("wall") for s in strips_of(p, view, storey.floor_m, storey.top_m)]
        storey.strips = cut_doors(join_corners(walls), storey.doors, view)
    _walk(storeys, view, positions)
    return storeys


def _boxes(graph: SceneGraph, storey: Storey, view: PlanView) -> Iterator[tuple[Kind[Any], Box]]:
    """Of what is in a room, where the room is; of all else, by the height of its foot."""
    rooms = {("room", room.id) for room in storey.rooms}
    for kind in KINDS:
        if not (kind.boxed and kind.in_plan):
            continue
        for node in graph.section(kind.section).values():
            box, parent = kind.box(node, graph), kind.parent(node)
            if box is None:
                continue
            foot = float(view.height(box.corners()).min())
            if parent in rooms if parent is not None else storey.holds(foot):
                yield kind, box


def _floor_heights(graph: SceneGraph, view: PlanView) -> list[float]:
    """Of the rooms, else of the grounds, else below everything."""
    heights = [_room_height(room, view) for room in graph.rooms.values()]
    if not heights:
        heights = [_height(plane.centroid, view) for plane in graph.planes_of("ground")]
    if not heights:
        cells = [plane.extent.cell_centres() for plane in graph.planes_of("wall")]
        low = [float(view.height(points).min()) for points in cells if len(points)]
        heights = [min(low, default=0.0)]
    floors: list[float] = []
    for height in sorted(heights):
        if not floors or height - floors[-1] > _APART_M:
            floors.append(height)
    return floors


def _room_height(room: RoomNode, view: PlanView) -> float:
    points = room.polygon if len(room.polygon) else room.centroid[None]
    return float(view.height(points).mean())


def _height(point: Array, view: PlanView) -> float:
    return float(view.height(point[None])[0])


def _walk(storeys: list[Storey], view: PlanView, positions: Array) -> None:
    """Gives each storey its stretches of the path; a camera is carried above the floor."""
    if not len(positions):
        return
    places, heights = view.flat(positions), view.height(positions)
    owner = np.array([max((i for i, s in enumerate(storeys) if h > s.floor_m), default=0) for h in heights])
    breaks = np.flatnonzero(np.diff(owner)) + 1
    for stretch, index in zip(np.split(places, breaks), owner[np.concatenate([[0], breaks])], strict=True):
        storeys[int(index)].path.append(stretch)
    storeys[int(owner[0])].start, storeys[int(owner[-1])].end = places[0], places[-1]
