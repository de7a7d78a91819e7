"""floorplan.svg: a scene graph seen from above."""

from __future__ import annotations

from typing import Any

import numpy as np

from vsgraphs.export.floorplan.furnishing import draw_frame, draw_legend, draw_title
from vsgraphs.export.floorplan.labels import dense, label_place
from vsgraphs.export.floorplan.storeys import Storey, storeys_of
from vsgraphs.export.floorplan.strips import Strip
from vsgraphs.export.floorplan.style import (
    CORRIDOR,
    DOOR,
    GROUND,
    INK,
    LINTEL,
    MARKER,
    ONE_FACE,
    PAPER,
    PATH,
    ROOMS,
    SOFT_INK,
    WALL,
)
from vsgraphs.export.floorplan.svg import Page, number, path_data
from vsgraphs.export.floorplan.view import PlanView, view_of
from vsgraphs.scene_graph import DoorNode, PlaneNode, RoomNode, SceneGraph
from vsgraphs.trajectory import Array

_MARGIN_PX, _HEAD_PX, _FOOT_PX, _PANEL_GAP_PX = 36.0, 74.0, 84.0, 40.0
_CAPTION_PX = 26.0
_LARGEST_PX = (1500.0, 950.0)
_BORDER_M = 0.45
_FINEST_PX_PER_M = 90.0


def format_floorplan(graph: SceneGraph, positions: Array | None = None, title: str = "Floor plan") -> str:
    """SVG text; equal input gives equal bytes. Works with walls only.

    positions: (N, 3) camera centres in the graph's frame, in order of time (see SceneGraph.poses_from_map).
    """
    walked = np.zeros((0, 3)) if positions is None else np.asarray(positions, dtype=np.float64)
    view = view_of(graph)
    storeys = storeys_of(graph, view, walked)
    low, size_m = _box(storeys, view)
    gaps_px = _PANEL_GAP_PX * (len(storeys) - 1)
    scale = min(
        _FINEST_PX_PER_M,
        (_LARGEST_PX[0] - gaps_px) / (len(storeys) * size_m[0]),
        _LARGEST_PX[1] / size_m[1],
    )
    panel_px = float(size_m[0]) * scale
    plan_px = panel_px * len(storeys) + gaps_px
    head_px = _HEAD_PX + (_CAPTION_PX if len(storeys) > 1 else 0.0)
    width = max(plan_px, 640.0) + 2 * _MARGIN_PX
    height = float(size_m[1]) * scale + head_px + _FOOT_PX
    page = Page()
    draw_frame(page, width, height)
    draw_title(page, graph, title, _MARGIN_PX)
    left = (width - plan_px) / 2
    bottom = height - _FOOT_PX
    for index, storey in enumerate(storeys):
        _Panel(page, view, low, np.array([left, bottom]), scale).draw(storey)
        if len(storeys) > 1:
            text = f"floor {index + 1}, {number(round(storey.floor_m, 1))} m"
            style: dict[str, Any] = {"font_size": 13, "fill": SOFT_INK, "text_anchor": "middle"}
            page.text(left + panel_px / 2, head_px - 8, text, **style)
        left += panel_px + _PANEL_GAP_PX
    draw_legend(page, storeys, view, scale, (_MARGIN_PX, height - _FOOT_PX + 40, width - _MARGIN_PX))
    return page.document(width, height, title)


def _box(storeys: list[Storey], view: PlanView) -> tuple[Array, Array]:
    """Lower left corner and size of what is drawn, with a border, metres; one for all storeys, so that what
    lies above one another on the ground does on the page.
    """
    parts = [np.zeros((0, 2))]
    for storey in storeys:
        parts += [strip.corners() for strip in storey.strips] + storey.path
        parts += [view.flat(room.polygon) for room in storey.rooms if len(room.polygon)]
        parts += [view.flat(plane.extent.polygon) for plane in storey.grounds]
    points = np.concatenate(parts)
    if not len(points):
        points = np.zeros((1, 2))
    low, high = points.min(axis=0) - _BORDER_M, points.max(axis=0) + _BORDER_M
    return low, np.maximum(high - low, 2.0)


class _Panel:
    """One storey on the page."""

    def __init__(self, page: Page, view: PlanView, low: Array, origin_px: Array, scale: float) -> None:
        self.page, self.view, self.low, self.origin, self.scale = page, view, low, origin_px, scale

    def px(self, points: Array) -> Array:
        """(N, 2) metres -> pixels."""
        away = (points - self.low) * self.scale
        return np.stack([self.origin[0] + away[:, 0], self.origin[1] - away[:, 1]], axis=1)

    def draw(self, storey: Storey) -> None:
        if not storey.rooms:
            for plane in storey.grounds:
                self.ground(plane)
        for room in storey.rooms:
            self.room(room)
        self.strips(storey.strips)
        for door in storey.doors:
            self.door(door)
        for stretch in storey.path:
            self.walk(stretch)
        for marker in storey.markers:
            self.marker(marker.world_from_marker[:3, 3], marker.name or str(marker.id))
        if storey.start is not None:
            x, y = self.px(storey.start[None])[0]
            self.page.circle(x, y, 4, fill=PAPER, stroke=PATH, stroke_width=1.8)
        if storey.end is not None:
            x, y = self.px(storey.end[None])[0]
            self.page.circle(x, y, 3.2, fill=PATH)
        lines = storey.path + [self.leaf(door) for door in storey.doors if door.kind != "passage"]
        busy = np.concatenate([dense(line) for line in lines]) if lines else np.zeros((0, 2))
        for room in storey.rooms:
            self.room_label(room, busy)

    def ground(self, plane: PlaneNode) -> None:
        extent, data = plane.extent, []
        for v, first, last in extent.runs:
            corners = np.array([[first, v], [last + 1, v], [last + 1, v + 1], [first, v + 1]]) * extent.cell_m
            data.append(path_data(self.px(self.view.flat(extent.lift(corners))), closed=True))
        self.page.path("".join(data), fill=GROUND, stroke=GROUND, stroke_width=0.4)

    def room(self, room: RoomNode) -> None:
        if len(room.polygon) < 3:
            return
        fill = CORRIDOR if room.kind == "corridor" else ROOMS[room.id % len(ROOMS)]
        # Walls and doors are drawn over it: what stays visible is where no wall was seen.
        dashed = {"stroke": SOFT_INK, "stroke_width": 1, "stroke_dasharray": "5 4"}
        self.page.polygon(self.px(self.view.flat(room.polygon)), fill=fill, **dashed)

    def room_label(self, room: RoomNode, busy: Array) -> None:
        if len(room.polygon) < 3:
            return
        name = room.name or f"{room.kind} {room.id}"
        place, free_m = label_place(self.view.flat(room.polygon), busy)
        x, y = self.px(place[None])[0]
        size = float(np.clip(2.6 * free_m * self.scale / max(len(name), 6), 12.0, 17.0))
        area = f"{room.area_m2:.1f} m²" + (", partly seen" if room.partial else "")
        style: dict[str, Any] = {"text_anchor": "middle", "halo": True}
        self.page.text(x, y - 0.1 * size, name, font_size=number(size), font_weight="bold", fill=INK, **style)
        self.page.text(
            x, y + 0.95 * size, area, font_size=number(max(0.75 * size, 10.0)), fill=SOFT_INK, **style
        )

    def strips(self, strips: list[Strip]) -> None:
        """Bodies first, then faces: a body must not cover its neighbour's face."""
        for strip in strips:
            corners = self.px(strip.corners())
            if not strip.solid:
                self.page.polygon(
                    corners, fill=LINTEL, stroke=SOFT_INK, stroke_width=0.6, stroke_dasharray="3 2"
                )
        for strip in strips:
            if strip.solid and not strip.two_sided:
                self.page.polygon(self.px(strip.corners()), fill=ONE_FACE)
        for strip in strips:
            if strip.solid and strip.two_sided:
                self.page.polygon(self.px(strip.corners()), fill=WALL, stroke=WALL, stroke_width=0.6)
        for strip in strips:
            if strip.solid:
                style = {"stroke": WALL, "stroke_width": 2, "stroke_linecap": "square"}
                self.page.line(self.px(strip.face()), **style)

    def leaf(self, door: DoorNode) -> Array:
        """(4, 2) metres: the open leaf's tip, hinge, latch, and the middle of the arc it swings."""
        center, through = self.view.flat(door.center[None])[0], self.view.direction(door.normal)
        half = np.array([-through[1], through[0]]) * door.width_m / 2
        hinge, latch = center - half, center + half
        arc = hinge + door.width_m * np.sqrt(0.5) * (through + half / max(float(np.linalg.norm(half)), 1e-9))
        return np.array([hinge + door.width_m * through, hinge, latch, arc])

    def door(self, door: DoorNode) -> None:
        through = self.view.direction(door.normal)
        tip, hinge, latch, _ = self.leaf(door)
        if door.kind == "passage":
            for side in (-0.06, 0.06):
                ends = np.array([hinge, latch]) + side * through
                self.page.line(self.px(ends), stroke=DOOR, stroke_width=1.2, stroke_dasharray="4 3")
            return
        leaf, a, b = self.px(np.array([tip, hinge, latch]))
        radius = number(door.width_m * self.scale)
        self.page.path(
            f"M{number(leaf[0])} {number(leaf[1])}A{radius} {radius} 0 0 0 {number(b[0])} {number(b[1])}",
            fill="none",
            stroke=DOOR,
            stroke_width=1,
            stroke_dasharray="2.5 2.5",
        )
        self.page.line(np.array([a, leaf]), stroke=DOOR, stroke_width=2.2, stroke_linecap="round")

    def walk(self, stretch: Array) -> None:
        kept = [stretch[0]]
        kept += [point for point in stretch[1:] if np.linalg.norm(point - kept[-1]) > 0.04]
        style = {"stroke": PATH, "stroke_width": 1.5, "stroke_linejoin": "round", "opacity": 0.8}
        self.page.line(self.px(np.array([*kept, stretch[-1]])), **style)

    def marker(self, position: Array, name: str) -> None:
        x, y = self.px(self.view.flat(position[None]))[0]
        self.page.rectangle(x - 3.5, y - 3.5, 7, 7, fill=MARKER, stroke=PAPER, stroke_width=1)
        self.page.text(x + 7, y + 3.5, name, halo=True, font_size=10, fill=MARKER)
