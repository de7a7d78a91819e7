"""An office floor: an open room, single offices and a store room that stays shut, on a corridor.

The open room has desks between half-height partitions, pillars and a glazed corner for meetings.
"""

from __future__ import annotations

from vsgraphs.plans.buildings.draw import Draw
from vsgraphs.plans.drawn.flat import _room, _visit, _window
from vsgraphs.plans.drawn.furnish import clutter_walls, furnish, shelve
from vsgraphs.plans.drawn.halls import WALL_M, Hall
from vsgraphs.plans.drawn.space import Place, Space

_BAY_M = 2.2  # of a desk between partitions


def add_offices(place: Place, draw: Draw) -> None:
    """Everything, and the way through it."""
    desks = 2 + draw.whole(2)
    wide = desks * _BAY_M + draw.uniform(3.0, 3.6)
    sizes = [(draw.uniform(3.2, 4.0), draw.uniform(3.8, 4.6)) for _ in range(2)]
    closet = (draw.uniform(1.5, 2.0), draw.uniform(1.4, 2.2))
    length = max(wide, sum(w for w, _ in sizes) + closet[0] + 2 * WALL_M)
    hall = Hall(place, draw, round(length, 3), draw.uniform(1.9, 2.2), draw.uniform(2.6, 3.0))
    visits = [_open_room(hall, wide, desks)]
    x = 0.0
    for number, size in enumerate(sizes):
        visits.append(_single(hall, f"office{number + 1}", x, size))
        x += size[0] + WALL_M
    _store(hall, x, closet)
    in_hall = hall.add("carpet", draw.uniform(0.4, 1.0))
    clutter_walls(in_hall, 0.6, (0, 2))
    people = ({"kind": "person", "speed": draw.uniform(0.9, 1.3)}, {"kind": "trolley", "speed": 0.6})
    in_hall.mover([(1.2, 0.4), (hall.length - 1.2, 0.4)], draw.choose(people))
    y = round(hall.width / 2, 3)
    place.site.waypoints.append({"at": [0.8, y], "look": [hall.length, y]})
    for space, door in sorted(visits, key=lambda visit: hall.at(visit[0].frame, visit[1])[0]):
        if space.room == "open":
            _through_open_room(hall, space, door)
        else:
            _visit(hall, space, door, 0.45 * space.depth)


def _open_room(hall: Hall, wide: float, desks: int) -> tuple[Space, float]:
    deep = hall.draw.uniform(5.6, 6.4)
    space, door = _room(
        hall, "open", "N", 0.0, (round(wide, 3), deep), {"height": hall.height, "floor": "carpet"}
    )
    draw = space.draw
    for k in range(desks):
        x = 0.15 + k * _BAY_M
        space.partition((x + _BAY_M - 0.1, deep - 0.02), (x + _BAY_M - 0.1, deep - 2.0),
                        {"height": draw.uniform(1.2, 1.5)})  # fmt: skip
        space.stand(2, x + 1.0, (1.5, 0.75, 0.74), {"kind": "table"})
        for shift, kind, size in ((-0.4, "screen", (0.55, 0.2, 0.45)), (0.35, "books", (0.28, 0.22, 0.2))):
            space.box((x + 1.0 + shift, deep - 0.45), size, {"kind": kind, "z": 0.74, "yaw_deg": 180.0})
        if draw.chance(0.5):
            space.mover([(x + 1.0, deep - 1.15)], {"kind": "person", "pose": "sit", "yaw_deg": 90.0})
        else:
            space.box((x + 1.0, deep - 1.2), (0.5, 0.5, 0.95), {"kind": "chair", "yaw_deg": 180.0})
        _window(space, 2, x + 0.1, x + 1.9)
        space.box((x + _BAY_M - 0.1, deep - 2.45), (0.4, 0.4, space.height), {"kind": "pillar"})
    space.keep_free(2, 0, desks * _BAY_M + 0.2)
    corner = round(desks * _BAY_M + 0.6, 3)
    space.partition((corner, deep - 0.03), (corner, 2.9), {"kind": "glass", "height": 2.3, "mullions": 0.9})
    space.box(((corner + wide) / 2 + 0.2, deep - 1.6), (1.2, 1.8, 0.74), {"kind": "table"})
    shelve(space, 3)
    clutter_walls(space, 0.7, (0, 1))
    return space, door


def _single(hall: Hall, name: str, x: float, size: tuple[float, float]) -> tuple[Space, float]:
    bare = hall.draw.chance(0.3)
    more = {"height": hall.height, "brightness": hall.draw.uniform(0.25, 1.1)}
    space, door = _room(hall, name, "S", x, size, more)
    w, _ = size
    _window(space, 2, 0.25 * w, 0.75 * w)
    if bare:
        return space, door
    space.stand(2, w / 2, (1.6, 0.75, 0.74), {"kind": "table"})
    if space.draw.chance(0.4):
        shelve(space, space.draw.choose((1, 3)))
    furnish(space, 0.8, (1, 3))
    clutter_walls(space, 0.8)
    return space, door


def _store(hall: Hall, x: float, size: tuple[float, float]) -> None:
    """Its door is shut, or moves: its name makes it so."""
    _room(hall, "store", "S", x, size, {"height": hall.height, "counted": False})


def _through_open_room(hall: Hall, space: Space, door: float) -> None:
    """Along the desks to the glazed corner, and back."""
    before, y = (door, -WALL_M - hall.width / 2), 1.6
    ends = (1.3, space.width - 1.1)
    first, last = ends if space.draw.chance(0.5) else ends[::-1]
    space.go(before, (door, 1.0))
    space.go((door, 0.45), (door, space.depth))
    space.go((door, y), (first, space.depth))
    for at, look in (
        ((first, y), (first, space.depth)),
        ((first, y), (space.width / 2, space.depth)),
        ((space.width / 2, y), (last, space.depth)),
        ((last, y), (last, space.depth)),
        ((last, y), (space.width / 2, 0.0)),
        ((door, y), (first, 0.0)),
        ((door, y), (door, -1.0)),
    ):
        space.go(at, look)
    space.go((door, 0.45), (door, -2.0))
    space.go(before, (door + 3.0, -WALL_M - hall.width / 2))
