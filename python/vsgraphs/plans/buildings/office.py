"""An office on a corridor, and a walk through it."""

from __future__ import annotations

from dataclasses import dataclass

from vsgraphs.plans.buildings.draw import Draw
from vsgraphs.plans.buildings.furnishing import Furnishing
from vsgraphs.plans.buildings.site import Frame, Item, Point, Site

WALL_M = 0.12  # thickness
DOOR_M = 0.95  # width
_DOOR_TO_CORNER_M = 0.9  # from the door's middle


@dataclass(frozen=True)
class Storey:
    """level: number; z_floor: metres."""

    level: int = 0
    z_floor: float = 0.0

    def keys(self) -> Item:
        """For a room of the plan; nothing on the ground floor."""
        return {"level": self.level, "z_floor": self.z_floor} if self.level else {}


@dataclass(frozen=True)
class Office:
    """A placed office. frame: that of furnishing.py; door: where its middle is, along wall 0."""

    room: str
    frame: Frame
    furnishing: Furnishing
    door: float


def door_place(draw: Draw, width: float) -> float:
    """To the left, to the right or, seldom, in the middle of wall 0."""
    return round(draw.choose((_DOOR_TO_CORNER_M, width - _DOOR_TO_CORNER_M) * 2 + (width / 2,)), 3)


def add_office(site: Site, office: Office, corridor: str, storey: Storey) -> None:
    """Room, door, window and what is inside."""
    made, frame = office.furnishing, office.frame
    w, d = made.width, made.depth
    room: Item = {
        "id": office.room,
        "polygon": [frame.point(corner) for corner in ((0, 0), (w, 0), (w, d), (0, d))],
        "floor": made.floor,
        "wall_colour": made.wall_colour,
        **storey.keys(),
    }
    site.rooms.append(room)
    site.door(frame, (corridor, office.room), (office.door, -WALL_M / 2))
    site.windows.append({"room": office.room, "wall": 2, "along": round(w / 2, 3), **made.window})
    for item in made.boxes:
        site.box(frame, office.room, item)
    site.posters += [{"room": office.room, **item} for item in made.posters]
    if made.beside_door is not None:
        along = {"wall": 0, "along": _beside(office.door, w)}
        site.posters.append({"room": office.room, **along, **made.beside_door})


def _beside(door: float, width: float) -> float:
    """Where something 0.6 m wide hangs on the door's wall."""
    if abs(door - width / 2) < 0.2:
        return 0.65
    return round(width - 1.2 if door < width / 2 else 1.2, 3)


def visit(site: Site, office: Office, corridor: str, before: float, draw: Draw) -> None:
    """From the corridor's middle, `before` metres from wall 0, in, once around, and out again."""
    w, d = office.furnishing.width, office.furnishing.depth
    way = draw.choose((-1, 1))  # which way round

    def near(x: float, y: float, spread: float) -> Point:
        return (
            w / 2 + way * x + draw.uniform(-spread, spread),
            y + draw.uniform(-spread, spread),
        )

    def stand(x: float, y: float) -> Point:
        return near(x, y, 0.06)

    def target(x: float, y: float) -> Point:
        return near(x, y, 0.15)

    outside, inside = (office.door, -before), (office.door, 0.5)
    steps: list[tuple[Point, Point]] = [
        (inside, target(0, d)),
        (stand(0, 1.5), target(w / 2, d)),
        (stand(0.1, 2.2), target(-w / 2, d - 0.3)),
        (stand(0, 2.3), target(-w / 2, 1.0)),
        (stand(-0.1, 2.2), target(0, 0)),
        (stand(0, 1.9), target(w / 2, 1.2)),
        (stand(0, 1.5), (office.door, -2.0)),
        (inside, (office.door, -3.0)),
    ]
    site.go(office.frame, corridor, outside)
    for at, look in steps:
        site.go(office.frame, office.room, at, look)
    site.go(office.frame, corridor, outside)
