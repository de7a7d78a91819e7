"""Turning a whole plan about the origin."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any


def rotate(plan: Any, angle_rad: float) -> None:
    """Turns every place and heading of `plan` (vsgraphs._core.Plan) counter-clockwise.

    Positions along walls need no change.
    """
    turn = _Turn(angle_rad)
    _each(plan, "rooms", turn.room)
    _each(plan, "doors", turn.door)
    _each(plan, "boxes", turn.box)
    _each(plan, "stairs", turn.stairs)
    _each(plan, "partitions", turn.stairs)
    _each(plan, "movers", turn.mover)
    path = plan.path
    _each(path, "waypoints", turn.waypoint)
    plan.path = path


def _each(owner: Any, name: str, change: Callable[[Any], None]) -> None:
    items = getattr(owner, name)  # the core hands out copies
    for item in items:
        change(item)
    setattr(owner, name, items)


class _Turn:
    def __init__(self, angle_rad: float) -> None:
        self._cos, self._sin = math.cos(angle_rad), math.sin(angle_rad)
        self._degrees = math.degrees(angle_rad)

    def point(self, p: tuple[float, float]) -> tuple[float, float]:
        return (self._cos * p[0] - self._sin * p[1], self._sin * p[0] + self._cos * p[1])

    def room(self, room: Any) -> None:
        room.polygon = [self.point(p) for p in room.polygon]
        if room.lamps is not None:
            room.lamps = [self.point(p) for p in room.lamps]

    def door(self, door: Any) -> None:
        door.at = self.point(door.at)

    def box(self, box: Any) -> None:
        box.at = self.point(box.at)
        box.yaw_deg += self._degrees

    def mover(self, mover: Any) -> None:
        mover.way = [self.point(p) for p in mover.way]
        mover.yaw_deg += self._degrees

    def stairs(self, stairs: Any) -> None:
        stairs.from_, stairs.to = self.point(stairs.from_), self.point(stairs.to)

    def waypoint(self, waypoint: Any) -> None:
        waypoint.at = self.point(waypoint.at)
        if waypoint.look is not None:
            waypoint.look = self.point(waypoint.look)
        if waypoint.yaw_deg is not None:
            waypoint.yaw_deg += self._degrees
