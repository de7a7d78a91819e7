"""A room to be furnished: what its walls have free, and things put against and onto them.

Its frame, as somebody sees it who comes in: the origin is the left corner of the door's wall, x runs along
that wall to the right, y into the room; walls 0 to 3: the door's, the right one, the far one, the left one.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from vsgraphs.plans.buildings.draw import Draw
from vsgraphs.plans.buildings.site import Frame, Item, Point, Site

GAP_M = 0.02  # to the wall: skirting boards are 1.4 cm thick
_YAW_DEG = (0.0, 90.0, 180.0, -90.0)
_TALL_M = 1.05  # what is higher hides what hangs behind it
Span = tuple[float, float]


@dataclass
class Place:
    """Everything placed so far, with what only drawn rooms have."""

    site: Site = field(default_factory=Site)
    partitions: list[Item] = field(default_factory=list)
    movers: list[Item] = field(default_factory=list)


@dataclass
class Space:
    """width: along the door's wall; depth: across; metres. stood, hung: what of each wall is taken."""

    place: Place
    frame: Frame
    room: str
    width: float
    depth: float
    height: float
    draw: Draw
    stood: dict[int, list[Span]] = field(default_factory=lambda: {i: [] for i in range(4)})
    hung: dict[int, list[Span]] = field(default_factory=lambda: {i: [] for i in range(4)})
    left_wall: int = 3  # its number in the plan: an alcove has walls of its own before it

    def length(self, wall: int) -> float:
        """Of a wall, metres."""
        return self.depth if wall % 2 else self.width

    def _at(self, wall: int, along: float, off: float) -> Point:
        """A point `along` a wall from its left end, seen from the door's side, `off` metres before it."""
        return (
            (along, off),
            (self.width - off, along),
            (along, self.depth - off),
            (off, along),
        )[wall]

    def _plan_along(self, wall: int, along: float) -> float:
        """The same as plans count it: counter-clockwise."""
        return round(along if wall < 2 else self.length(wall) - along, 3)

    def keep_free(self, wall: int, low: float, high: float) -> None:
        """Nothing stands or hangs there."""
        self.stood[wall].append((low, high))
        self.hung[wall].append((low, high))

    def stand(self, wall: int, along: float, size: tuple[float, float, float], item: Item) -> Point:
        """Furniture with its back against a wall, `along` its middle. size: length, depth, height."""
        length, depth, height = size
        low, high = along - length / 2, along + length / 2
        self.stood[wall].append((low - 0.03, high + 0.03))
        if height > _TALL_M:
            self.hung[wall].append((low - 0.05, high + 0.05))
        at = self._at(wall, along, GAP_M + depth / 2)
        self.box(at, size, {**item, "yaw_deg": _YAW_DEG[wall]})
        return at

    def box(self, at: Point, size: tuple[float, float, float], item: Item) -> None:
        """Furniture anywhere."""
        place = {"at": at, "size": list(size), "seed": self.draw.seed(), "yaw_deg": 0.0}
        self.place.site.box(self.frame, self.room, {**place, **item})

    def hang(self, wall: int, along: float, item: Item) -> None:
        """Flat on a wall, `along` its middle."""
        width = item["width"]
        self.hung[wall].append((along - width / 2 - 0.04, along + width / 2 + 0.04))
        hung = {
            "room": self.room,
            "wall": self.left_wall if wall == 3 else wall,
            "along": self._plan_along(wall, along),
        }
        self.place.site.posters.append({**hung, "seed": self.draw.seed(), **item})

    def window(self, wall: int, along: float, item: Item) -> None:
        """In a wall, `along` its middle."""
        half = item["width"] / 2 + 0.12
        self.hung[wall].append((along - half, along + half + (0.45 if item.get("curtain") else 0)))
        placed = {
            "room": self.room,
            "wall": self.left_wall if wall == 3 else wall,
            "along": self._plan_along(wall, along),
        }
        self.place.site.windows.append({**placed, "seed": self.draw.seed(), **item})

    def partition(self, start: Point, end: Point, item: Item) -> None:
        """Free in the room."""
        ends = {"from": self.frame.point(start), "to": self.frame.point(end)}
        self.place.partitions.append({"room": self.room, **ends, **item})

    def mover(self, way: list[Point], item: Item) -> None:
        """Somebody in the room."""
        placed = {"room": self.room, "way": [self.frame.point(p) for p in way], "seed": self.draw.seed()}
        if "yaw_deg" in item:
            item = {**item, "yaw_deg": self.frame.yaw_deg(item["yaw_deg"])}
        self.place.movers.append({**placed, **item})

    def gap(self, taken: list[Span], wall: int, width: float, margin: float = 0.08) -> float | None:
        """The middle of a free stretch of a wall, drawn; None if there is none."""
        length = self.length(wall)
        free, reached = [], margin
        for low, high in sorted([*taken, (length - margin, length)]):
            if low - reached > width:
                free.append((reached + width / 2, low - width / 2))
            reached = max(reached, high)
        share = self.draw.share()
        if not free:
            return None
        low, high = self.draw.choose(free)
        return round(low + share * (high - low), 3)

    def go(self, at: Point, look: Point | None = None, **more: float) -> None:
        """The next way-point."""
        self.place.site.go(self.frame, self.room, at, look, **more)
