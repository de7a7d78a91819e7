"""A flat: a hall with a living room, a bedroom, a kitchen, a study under the roof and a bath that stays shut.

At the end of the hall is a round bay.
"""

from __future__ import annotations

from vsgraphs.plans.buildings.draw import Draw
from vsgraphs.plans.buildings.site import Item
from vsgraphs.plans.drawn.furnish import clutter_walls, furnish, mirror, shelve
from vsgraphs.plans.drawn.halls import (
    WALL_M,
    Hall,
    open_door,
    rectangle,
    round_room,
    shut_door,
    with_alcove,
)
from vsgraphs.plans.drawn.space import Place, Space

_PICTURE, _BUILT = "picture", ("parapet", "street", "street")


def add_flat(place: Place, draw: Draw) -> None:
    """Everything, and the way through it."""
    sizes = {
        "living": (draw.uniform(4.6, 5.4), draw.uniform(4.0, 4.8)),
        "bedroom": (draw.uniform(3.6, 4.2), draw.uniform(3.8, 4.4)),
        "kitchen": (draw.uniform(3.3, 3.9), draw.uniform(3.2, 3.8)),
        "bath": (draw.uniform(1.7, 2.1), draw.uniform(2.0, 2.6)),
        "study": (draw.uniform(3.3, 3.8), draw.uniform(3.6, 4.2)),
    }
    north, south = draw.shuffled(("living", "bedroom")), draw.shuffled(("kitchen", "bath", "study"))
    rows = {"N": north, "S": south}
    length = max(sum(sizes[name][0] + WALL_M for name in row) for row in rows.values())
    hall = Hall(place, draw, round(length, 3), draw.uniform(1.5, 1.9), draw.uniform(2.4, 2.8))
    visits: list[tuple[float, Space, float]] = []
    for side, row in rows.items():
        x = 0.0
        for name in row:
            space, door = _ROOMS[name](hall, name, side, x, sizes[name])
            if name != "bath":
                visits.append((hall.at(space.frame, door)[0], space, door))
            x += sizes[name][0] + WALL_M
    bay, door = _bay(hall)
    in_hall = hall.add(draw.choose(("wood", "tiles", "terrazzo")), draw.uniform(0.35, 1.1))
    _end_of_hall(in_hall, draw)
    _walk(hall, visits, (bay, door))


def _room(
    hall: Hall, name: str, side: str, x: float, size: tuple[float, float], more: Item, alcove: float = 0.0
) -> tuple[Space, float]:
    """A room with its door; `alcove`: depth of one in its far wall."""
    width, depth = size
    draw = Draw(hall.draw.seed(), name)
    frame = hall.frame(side, x, width)
    height = more["height"]
    polygon = rectangle(width, depth)
    if alcove:
        polygon = with_alcove(width, depth, 0.25 * width, 0.6 * width, alcove)
    hall.room(name, frame, polygon, more)
    space = Space(hall.place, frame, name, width, depth, height, draw)
    space.left_wall = len(polygon) - 1
    # The floor of a doorway is the higher one, and the door has to fit under both ceilings.
    step = more.get("z_floor", 0.0)
    item = (
        shut_door(draw, name)
        if name in ("bath", "store")
        else open_door(draw, name, min(height, hall.height - step), width - 1.02)
    )
    item["height"] = min(item["height"], round(hall.height - step - 0.012, 3), round(height - 0.012, 3))
    half = item.get("width", 0.9) / 2
    door = round(draw.uniform(half + 0.5, width - half - 0.5), 3)
    hall.door(name, frame, door, item)
    space.keep_free(0, door - half - 0.15, door + half + 0.15)
    return space, door


def _window(space: Space, wall: int, low: float, high: float) -> None:
    """Where nothing stands before it higher than its sill."""
    width = round(min(space.draw.uniform(1.0, 1.7), high - low - 0.5), 3)
    sill = space.draw.choose((0.9, 0.9, 0.7, 0.35))
    view = space.draw.choose(_BUILT)
    space.window(wall, (low + high) / 2, {
        "width": width, "height": round(min(1.35, space.height - sill - 0.3), 3), "sill": sill, "view": view,
        "curtain": space.draw.chance(0.4), "radiator": sill > 0.6 and space.draw.chance(0.6),
    })  # fmt: skip


def _living(hall: Hall, name: str, side: str, x: float, size: tuple[float, float]) -> tuple[Space, float]:
    height = round(hall.height + hall.draw.uniform(0.0, 0.3), 3)
    space, door = _room(hall, name, side, x, size, {"height": height})
    w, d = size
    _window(space, 2, 0.3 * w, 0.7 * w)
    shelf = space.draw.choose((1, 3))
    shelve(space, shelf)
    if space.draw.chance(0.7):  # a glass wall from the other side into the room
        edge = 0.0 if shelf == 1 else w
        end = 1.3 if shelf == 1 else w - 1.3
        y = 0.66 * d
        space.partition((edge + (0.03 if edge == 0 else -0.03), y), (end, y),
                        {"kind": "glass", "height": 2.1, "mullions": 0.65})  # fmt: skip
        space.stood[4 - shelf].append((y - 0.1, y + 0.1))
    space.stand(2, w / 2, (1.9, 0.8, 0.8), {"kind": "sofa"})
    space.box((w / 2, 0.5 * d), (1.8, 1.3, 0.01), {"kind": "rug"})
    furnish(space, 0.7, (4 - shelf, 2))
    clutter_walls(space, 0.8)
    if space.draw.chance(0.6):
        space.mover([(w / 2 + 0.5, d - 0.62)], {"kind": "person", "pose": "sit", "yaw_deg": -90.0})
    return space, door


def _bedroom(hall: Hall, name: str, side: str, x: float, size: tuple[float, float]) -> tuple[Space, float]:
    space, door = _room(
        hall, name, side, x, size, {"height": hall.height, "brightness": hall.draw.uniform(0.3, 1.0)}
    )
    w, d = size
    space.stand(2, w / 2, (1.5, 1.35, 0.5), {"kind": "bed"})
    _window(space, space.draw.choose((1, 3)), 0.35 * d, 0.85 * d)
    mirror(space, space.draw.choose((1, 3)))
    furnish(space, 0.8, (1, 3))
    clutter_walls(space, 0.5)
    return space, door


def _kitchen(hall: Hall, name: str, side: str, x: float, size: tuple[float, float]) -> tuple[Space, float]:
    step = hall.draw.choose((0.0, 0.1, 0.18, 0.3, 0.4))
    more = {"height": round(hall.height - step, 3), "z_floor": step, "floor": "tiles", "brightness": 1.1}
    w, d = size
    space, door = _room(hall, name, side, x, size, more, alcove=hall.draw.uniform(0.4, 0.8))
    space.keep_free(2, 0, w)  # an alcove, not a wall of one piece
    wall = space.draw.choose((1, 3))
    along = 0.35
    while along + 0.3 < d - 0.1:
        space.stand(wall, along, (0.58, 0.58, 0.9), {"kind": "drawers"})
        along += 0.6
    _window(space, 4 - wall, 0.4 * d, 0.9 * d)
    space.stand(4 - wall, 0.62 * d, (1.1, 0.7, 0.74), {"kind": "table"})
    furnish(space, 0.4, (4 - wall,))
    clutter_walls(space, 0.8, (0, 1, 3))
    if space.draw.chance(0.4):
        space.mover([(0.42 * w, d + 0.1)], {"kind": "person", "pose": "stand", "yaw_deg": -90.0})
    return space, door


def _bath(hall: Hall, name: str, side: str, x: float, size: tuple[float, float]) -> tuple[Space, float]:
    space, door = _room(
        hall, name, side, x, size, {"height": hall.height, "counted": False, "floor": "tiles"}
    )
    mirror(space, 2)
    return space, door


def _study(hall: Hall, name: str, side: str, x: float, size: tuple[float, float]) -> tuple[Space, float]:
    slope = {"wall": 2, "knee": hall.draw.uniform(1.0, 1.5), "reach": hall.draw.uniform(1.2, 1.9)}
    more = {"height": hall.height, "slope": slope, "lamps": []}
    space, door = _room(hall, name, side, x, size, more)
    w, d = size
    frame_lamp = space.frame.point((w / 2, (d - slope["reach"]) / 2))
    hall.place.site.rooms[-1]["lamps"] = [frame_lamp]
    for wall in (1, 3):  # the ceiling comes down over the end of these
        space.keep_free(wall, d - slope["reach"] - 0.1, d)
    space.stand(2, w / 2, (1.4, 0.6, 0.74), {"kind": "table"})
    space.keep_free(2, 0, w)
    furnish(space, 0.9, (1, 3))
    clutter_walls(space, 0.9, (0, 1, 3))
    return space, door


def _bay(hall: Hall) -> tuple[Space, float]:
    """Round and bare."""
    width, radius = 1.5, hall.draw.uniform(1.6, 2.0)
    frame = hall.frame("E", 0, width)
    hall.room("bay", frame, round_room(width, radius), {"height": hall.height, "skirting": False,
                                                        "wall_colour": "#dededa"})  # fmt: skip
    hall.door("bay", frame, width / 2, {"width": 1.0, "height": min(2.05, hall.height - 0.05)})
    space = Space(hall.place, frame, "bay", width, 2 * radius, hall.height, hall.draw)
    return space, width / 2


def _end_of_hall(space: Space, draw: Draw) -> None:
    mirror(space, 3)
    clutter_walls(space, 0.7, (0, 2))
    if draw.chance(0.7):
        space.mover(
            [(1.0, 0.33), (space.width - 1.0, 0.33)], {"kind": "person", "speed": draw.uniform(0.7, 1.2)}
        )


def _walk(hall: Hall, visits: list[tuple[float, Space, float]], end: tuple[Space, float]) -> None:
    y = hall.width / 2
    hall.place.site.waypoints.append({"at": [0.8, round(y, 3)], "look": [hall.length, round(y, 3)]})
    for _, space, door in sorted(visits, key=lambda visit: visit[0]):
        _visit(hall, space, door, 0.5 * space.depth)
    space, door = end
    _visit(hall, space, door, 0.42 * space.depth)


def _visit(hall: Hall, space: Space, door: float, deep: float) -> None:
    """In, once around, out again: never nearer than 0.9 m to where furniture may stand."""
    before = (door, -WALL_M - hall.width / 2)
    x = min(max(door, 1.2), max(space.width - 1.2, 0.5 * space.width))
    middle = (0.5 * (x + 0.5 * space.width), deep)
    space.go(before, (door, 1.0))
    space.go((door, 0.45), (0.5 * space.width, space.depth))
    turns = [
        (0.0, space.depth), (-1.0, 0.3 * space.depth), (0.5 * space.width, -1.0),
        (space.width, 0.3 * space.depth),
             (space.width, space.depth)]  # fmt: skip
    way = turns if space.draw.chance(0.5) else turns[::-1]
    for look in way:
        space.go(middle, look)
    space.go((door, 0.45), (door, -2.0))
    space.go(before, (door + 3.0, -WALL_M - hall.width / 2))


_ROOMS = {"living": _living, "bedroom": _bedroom, "kitchen": _kitchen, "bath": _bath, "study": _study}
