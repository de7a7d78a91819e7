"""A hall with rooms on both sides and at its end, and the doors between."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from vsgraphs.plans.buildings.draw import Draw
from vsgraphs.plans.buildings.site import Frame, Item, Point
from vsgraphs.plans.drawn.space import Place, Space

WALL_M = 0.14
_FLOORS = ("tiles", "wood", "carpet", "terrazzo", "wood", "concrete")
_WALLS = ("#d6d3cc", "#dcdcd8", "#c9d0d2", "#d8cfc0", "#e0e0de", "#c4b8a8")


@dataclass
class Hall:
    """Along x from 0, y from 0 to `width`."""

    place: Place
    draw: Draw
    length: float
    width: float
    height: float
    name: str = "hall"
    used: dict[str, list[tuple[float, float]]] = field(default_factory=lambda: {"N": [], "S": []})

    def add(self, floor: str, brightness: float) -> Space:
        """The hall itself, as a space whose wall 0 is the one in the south."""
        frame = Frame()
        corners = ((0, 0), (self.length, 0), (self.length, self.width), (0, self.width))
        self.place.site.rooms.append({
            "id": self.name, "kind": "corridor", "polygon": [frame.point(c) for c in corners],
            "floor": floor, "height": self.height, "brightness": brightness, "ceiling": "plain",
        })  # fmt: skip
        space = Space(self.place, frame, self.name, self.length, self.width, self.height, self.draw)
        for wall, side in ((0, "S"), (2, "N")):
            for low, high in self.used[side]:
                space.keep_free(wall, low, high)
        return space

    def frame(self, side: str, x: float, width: float) -> Frame:
        """Of a room beside the hall that begins at x, or (E) at its end."""
        if side == "N":
            return Frame(x, self.width + WALL_M, 0)
        if side == "S":
            return Frame(x + width, -WALL_M, 180)
        return Frame(self.length + WALL_M, self.width / 2 + width / 2, -90)

    def at(self, frame: Frame, along: float) -> Point:
        """The middle of the hall before a point of a room's wall 0."""
        x, y = frame.point((along, -WALL_M - self.width / 2))
        return (min(max(x, 0.7), self.length - 0.7), y)

    def room(self, name: str, frame: Frame, polygon: list[Point], more: Item) -> None:
        """A room with its own height, light and surfaces."""
        item: Item = {
            "id": name,
            "polygon": [frame.point(p) for p in polygon],
            "floor": self.draw.choose(_FLOORS),
            "wall_colour": self.draw.choose(_WALLS),
            "ceiling": "plain" if self.draw.chance(0.7) else "panels",
            "skirting": self.draw.chance(0.7),
            **more,
        }
        self.place.site.rooms.append(item)

    def door(self, name: str, frame: Frame, along: float, item: Item) -> None:
        """Between the hall and a room, `along` the room's wall 0."""
        at = frame.point((along, -WALL_M / 2))
        self.place.site.doors.append({"rooms": [self.name, name], "at": at, **item})
        half = item.get("width", 0.95) / 2 + 0.15
        x = at[0]
        if frame.angle_deg != -90:
            self.used["N" if frame.angle_deg == 0 else "S"].append((x - half, x + half))


def open_door(draw: Draw, room: str, top: float, most: float) -> Item:
    """One that is walked through: no leaf, one wide open, or a pair.

    top: height of the lower room; most: width there is room for, metres.
    """
    kind = draw.choose(("none", "open", "open", "pair", "high"))
    if kind == "pair":
        leaf = {"room": room, "angle_deg": draw.uniform(95, 120), "pair": True}
        return {"width": min(draw.uniform(1.5, 2.5), round(most, 3)), "height": 2.1, "leaf": leaf}
    width = draw.uniform(0.85, 1.0)
    if kind == "none":
        return {"width": width, "height": 2.05}
    height = round(top - 0.012, 3) if kind == "high" else draw.uniform(1.98, 2.12)
    hinge = draw.choose(("left", "right"))
    return {
        "width": width,
        "height": height,
        "leaf": {"room": room, "angle_deg": draw.uniform(88, 115), "hinge": hinge},
    }


def shut_door(draw: Draw, room: str) -> Item:
    """One that is passed by: closed and set back in its frame, half open, or now this, now that."""
    kind = draw.choose(("closed", "closed", "ajar", "moving"))
    leaf: Item = {"room": room, "hinge": draw.choose(("left", "right")), "angle_deg": 0.0}
    if kind == "closed":
        leaf["set_back"] = draw.uniform(0.02, 0.1)
    elif kind == "ajar":
        leaf["angle_deg"] = draw.uniform(15, 70)
    else:
        leaf["turns"] = [[draw.uniform(8, 20), draw.uniform(40, 90)], [draw.uniform(30, 50), 0.0]]
    return {"width": draw.uniform(0.8, 0.95), "height": draw.uniform(1.98, 2.1), "leaf": leaf}


def rectangle(width: float, depth: float) -> list[Point]:
    """Corners, from the left end of the door's wall."""
    return [(0, 0), (width, 0), (width, depth), (0, depth)]


def with_alcove(width: float, depth: float, low: float, high: float, deep: float) -> list[Point]:
    """The far wall steps back by `deep` between low and high."""
    return [(0, 0), (width, 0), (width, depth), (high, depth), (high, depth + deep), (low, depth + deep),
            (low, depth), (0, depth)]  # fmt: skip


def round_room(width: float, radius: float, sides: int = 20) -> list[Point]:
    """A circle cut off at the door's wall, which is `width` long."""
    middle = width / 2
    up = math.sqrt(radius**2 - middle**2)
    start = math.atan2(-up, middle)
    sweep = 2 * math.pi - 2 * (math.pi / 2 + start)
    points: list[Point] = [(0, 0), (width, 0)]
    for k in range(1, sides):
        angle = start + sweep * k / sides
        points.append((middle + radius * math.cos(angle), up + radius * math.sin(angle)))
    return points
