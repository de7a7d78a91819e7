"""One storey on the page: rooms, walls, doors, what stands there, the way of the camera."""

from __future__ import annotations

from typing import Any

import numpy as np

from vsgraphs.export.floorplan.labels import dense, label_place
from vsgraphs.export.floorplan.storeys import Storey
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
    hex_colour,
)
from vsgraphs.export.floorplan.svg import Page, number, path_data
from vsgraphs.export.floorplan.view import PlanView
from vsgraphs.scene_graph import Box, DoorNode, PlaneNode, RoomNode
from vsgraphs.trajectory import Array


class Panel:
    """One storey on the page."""

    def __init__(self, page: Page, view: PlanView, low: Array, origin_px: Array, scale: float) -> None:
        self.page, self.view, self.low, self.origin, self.scale = page, view, low, origin_px, scale

    def px(self, points: Array) -> Array:
        """(N, 2) metres -> pixels."""
        away = (points - self.low) * self.scale
        return np.stack([self.origin[0] + away[:, 0], self.origin[1] - away[:, 1]], axis=1)

    def draw(self, storey: Storey) -> None:
        """What lies below first."""
        if not storey.rooms:
            for plane in storey.grounds:
                self._ground(plane)
        for room in storey.rooms:
            self._room(room)
        self._strips(storey.strips)
        for kind, box in storey.boxes:
            self._box(box, hex_colour(kind.colour))
        for door in storey.doors:
            self._door(door)
        for stretch in storey.path:
            self._walk(stretch)
        for marker in storey.markers:
            self._marker(marker.world_from_marker[:3, 3], marker.name or str(marker.id))
        if storey.start is not None:
            x, y = self.px(storey.start[None])[0]
            self.page.circle(x, y, 4, fill=PAPER, stroke=PATH, stroke_width=1.8)
        if storey.end is not None:
            x, y = self.px(storey.end[None])[0]
            self.page.circle(x, y, 3.2, fill=PATH)
        lines = storey.path + [self._leaf(door) for door in storey.doors if door.kind != "passage"]
        lines += [self.view.flat(box.corners()[:4]) for _, box in storey.boxes]
        busy = np.concatenate([dense(line) for line in lines]) if lines else np.zeros((0, 2))
        for room in storey.rooms:
            self._room_label(room, busy)

    def _ground(self, plane: PlaneNode) -> None:
        extent, data = plane.extent, []
        for v, first, last in extent.runs:
            corners = np.array([[first, v], [last + 1, v], [last + 1, v + 1], [first, v + 1]]) * extent.cell_m
            data.append(path_data(self.px(self.view.flat(extent.lift(corners))), closed=True))
        self.page.path("".join(data), fill=GROUND, stroke=GROUND, stroke_width=0.4)

    def _room(self, room: RoomNode) -> None:
        if len(room.polygon) < 3:
            return
        fill = CORRIDOR if room.kind == "corridor" else ROOMS[room.id % len(ROOMS)]
        # Walls and doors are drawn over it: what stays visible is where no wall was seen.
        dashed = {"stroke": SOFT_INK, "stroke_width": 1, "stroke_dasharray": "5 4"}
        self.page.polygon(self.px(self.view.flat(room.polygon)), fill=fill, **dashed)

    def _room_label(self, room: RoomNode, busy: Array) -> None:
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

    def _strips(self, strips: list[Strip]) -> None:
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

    def _leaf(self, door: DoorNode) -> Array:
        """(4, 2) metres: the open leaf's tip, hinge, latch, and the middle of the arc it swings."""
        center, through = self.view.flat(door.center[None])[0], self.view.direction(door.normal)
        half = np.array([-through[1], through[0]]) * door.width_m / 2
        hinge, latch = center - half, center + half
        arc = hinge + door.width_m * np.sqrt(0.5) * (through + half / max(float(np.linalg.norm(half)), 1e-9))
        return np.array([hinge + door.width_m * through, hinge, latch, arc])

    def _door(self, door: DoorNode) -> None:
        through = self.view.direction(door.normal)
        tip, hinge, latch, _ = self._leaf(door)
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

    def _box(self, box: Box, colour: str) -> None:
        """Its foot; one without depth is a stroke."""
        style = {"fill": colour, "fill_opacity": 0.35, "stroke": colour, "stroke_width": 2}
        self.page.polygon(self.px(self.view.flat(box.corners()[:4])), **style)

    def _walk(self, stretch: Array) -> None:
        kept = [stretch[0]]
        kept += [point for point in stretch[1:] if np.linalg.norm(point - kept[-1]) > 0.04]
        style = {"stroke": PATH, "stroke_width": 1.5, "stroke_linejoin": "round", "opacity": 0.8}
        self.page.line(self.px(np.array([*kept, stretch[-1]])), **style)

    def _marker(self, position: Array, name: str) -> None:
        x, y = self.px(self.view.flat(position[None]))[0]
        self.page.rectangle(x - 3.5, y - 3.5, 7, 7, fill=MARKER, stroke=PAPER, stroke_width=1)
        self.page.text(x + 7, y + 3.5, name, halo=True, font_size=10, fill=MARKER)
