"""What a plan is put together from: frames to place things in, and the lists of everything placed."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

Item = dict[str, Any]  # an object of the plan, as in JSON
Point = tuple[float, float]


@dataclass(frozen=True)
class Frame:
    """Where a part of the building lies: metres in the plan, turned counter-clockwise."""

    x: float = 0.0
    y: float = 0.0
    angle_deg: float = 0.0

    def _turned(self, p: Point) -> Point:
        c, s = math.cos(math.radians(self.angle_deg)), math.sin(math.radians(self.angle_deg))
        return (self.x + c * p[0] - s * p[1], self.y + s * p[0] + c * p[1])

    def point(self, p: Point) -> list[float]:
        """A point of this frame in the plan, to 0.1 mm."""
        x, y = self._turned(p)
        return [round(x, 4) + 0.0, round(y, 4) + 0.0]  # + 0.0: no -0.0

    def yaw_deg(self, yaw_deg: float) -> float:
        """A heading of this frame in the plan, within (-180, 180]."""
        return round(180 - (180 - yaw_deg - self.angle_deg) % 360, 3) + 0.0

    def part(self, x: float, y: float, angle_deg: float = 0.0) -> Frame:
        """A frame given in this one."""
        there = self._turned((x, y))
        return Frame(there[0], there[1], self.angle_deg + angle_deg)


@dataclass
class Site:
    """Everything placed so far. stacked: rooms lie above one another, so way-points name theirs."""

    stacked: bool = False
    rooms: list[Item] = field(default_factory=list)
    doors: list[Item] = field(default_factory=list)
    windows: list[Item] = field(default_factory=list)
    posters: list[Item] = field(default_factory=list)
    boxes: list[Item] = field(default_factory=list)
    stairs: list[Item] = field(default_factory=list)
    waypoints: list[Item] = field(default_factory=list)

    def door(self, frame: Frame, rooms: tuple[str, str], at: Point, width: float | None = None) -> None:
        """An opening between two rooms."""
        extra = {} if width is None else {"width": width}
        self.doors.append({"rooms": list(rooms), "at": frame.point(at), **extra})

    def box(self, frame: Frame, room: str, item: Item) -> None:
        """Furniture given in `frame`."""
        placed = {"at": frame.point(item["at"]), "yaw_deg": frame.yaw_deg(item["yaw_deg"])}
        self.boxes.append({"kind": item["kind"], "room": room, **item, **placed})

    def go(self, frame: Frame, room: str, at: Point, look: Point | None = None, **more: float) -> None:
        """The next way-point; without `look` the camera looks along the way."""
        point: Item = {"at": frame.point(at)}
        if look is not None:
            point["look"] = frame.point(look)
        if self.stacked:
            point["room"] = room
        self.waypoints.append({**point, **more})

    def way(self) -> list[Item]:
        """All way-points but those that would have to look along no way at all."""
        following = [*self.waypoints[1:], self.waypoints[0]]
        return [
            here
            for here, there in zip(self.waypoints, following, strict=True)
            if "look" in here or math.dist(here["at"], there["at"]) > 0.05
        ]
