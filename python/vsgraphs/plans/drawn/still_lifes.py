"""A desk and a kitchen as recordings show them: things close by, printed, on tables; one room, no doors.

Like TUM fr1/xyz (a desk from 0.7 to 1.5 m, moved along the axes by hand) and 7-Scenes redkitchen (cupboards,
a table with magazines, from the hand), to compare the simulator with.
"""

from __future__ import annotations

from vsgraphs.plans.buildings.draw import Draw
from vsgraphs.plans.buildings.site import Frame, Point
from vsgraphs.plans.drawn.furnish import clutter_walls, shelve
from vsgraphs.plans.drawn.halls import rectangle
from vsgraphs.plans.drawn.space import Place, Space

_HEIGHT_M, _TABLE_M = 2.6, 0.74
# kind, width, depth, height of what lies on tables; that which stands comes behind it
_LYING = (
    ("papers", 0.21, 0.3, 0.005),
    ("magazine", 0.22, 0.29, 0.008),
    ("papers", 0.21, 0.3, 0.01),
    ("magazine", 0.15, 0.2, 0.045),
    ("mug", 0.08, 0.08, 0.1),
    ("pens", 0.08, 0.08, 0.17),
    ("magazine", 0.12, 0.17, 0.02),
    ("carton", 0.08, 0.06, 0.12),
    ("carton", 0.12, 0.07, 0.05),
)
_STANDING = (
    ("booklet", 0.18, 0.02, 0.25),
    ("carton", 0.16, 0.12, 0.2),
    ("booklet", 0.21, 0.03, 0.29),
    ("booklet", 0.15, 0.02, 0.2),
    ("carton", 0.09, 0.06, 0.16),
    ("pens", 0.09, 0.09, 0.18),
    ("mug", 0.09, 0.09, 0.1),
)


def _room(
    place: Place, draw: Draw, name: str, size: Point, lamps: list[list[float]], wall: str = "#b4b4ac"
) -> Space:
    width, depth = size
    frame = Frame()
    place.site.rooms.append({
        "id": name, "polygon": [frame.point(p) for p in rectangle(width, depth)], "height": _HEIGHT_M,
        "floor": "carpet", "ceiling": "plain", "brightness": 1.1, "lamps": lamps,
        "wall_colour": wall,
    })  # fmt: skip
    return Space(place, frame, name, width, depth, _HEIGHT_M, draw)


def _strew(
    space: Space,
    low: Point,
    high: Point,
    z: float,
    what: tuple[tuple[str, float, float, float], ...],
    gap: float = 0.04,
) -> None:
    """Things in rows over a rectangle, each turned a little. gap: between them at most, metres."""
    draw, y = space.draw, low[1]
    while y < high[1] - 0.05:
        x, deepest = low[0] + draw.uniform(0, 0.05), 0.0
        while True:
            kind, width, depth, height = draw.choose(what)
            if x + width > high[0]:
                break
            if y + depth <= high[1] + 0.02:
                at = (x + width / 2, y + depth / 2)
                turn = 180 + draw.uniform(-22, 22)
                space.box(at, (width, depth, height), {"kind": kind, "z": z, "yaw_deg": turn})
                deepest = max(deepest, depth)
                x += 0.05 * width
            x += width + draw.uniform(0.0, gap)
        y += max(0.1, deepest + draw.uniform(0.01, 0.04))


def _scatter(space: Space, low: Point, high: Point, z: float, count: int) -> None:
    """Pens, erasers and other small things, on whatever lies there."""
    draw = space.draw
    for _ in range(count):
        size = draw.choose(
            ((0.14, 0.011, 0.012), (0.045, 0.02, 0.013), (0.06, 0.05, 0.02), (0.09, 0.03, 0.02))
        )
        at = (draw.uniform(low[0], high[0]), draw.uniform(low[1], high[1]))
        space.box(at, size, {"kind": "carton", "z": z + 0.006, "yaw_deg": draw.uniform(-90, 90)})


def add_desk(place: Place, draw: Draw) -> None:
    """A full desk in a room; the camera goes to and fro along its axes and hardly turns."""
    w, d, back = 4.2, 5.4, 3.3
    space = _room(
        place, draw, "study", (w, d), [[w / 2 + x, y] for x in (-0.8, 0.8) for y in (1.6, 3.6)], "#6c6c66"
    )
    left, right, front = w / 2 - 1.05, w / 2 + 1.05, back - 0.95
    space.box((w / 2, back - 0.475), (2.2, 0.95, _TABLE_M), {"kind": "table", "colour": "#fffef8"})
    for x, size in ((w / 2 + 0.2, (0.52, 0.2, 0.46)), (w / 2 - 0.8, (0.42, 0.18, 0.36))):
        space.box((x, back - 0.3), size, {"kind": "dark_screen", "z": _TABLE_M, "yaw_deg": 180.0})
    keys = {"kind": "keyboard", "z": _TABLE_M, "yaw_deg": 176.0}
    space.box((w / 2 + 0.25, front + 0.14), (0.46, 0.17, 0.03), keys)
    _strew(space, (left, front + 0.02), (w / 2 - 0.02, back - 0.42), _TABLE_M, _LYING, 0.015)
    _strew(space, (w / 2 + 0.52, front + 0.02), (right, back - 0.42), _TABLE_M, _LYING, 0.015)
    _strew(space, (w / 2, front + 0.27), (w / 2 + 0.5, back - 0.45), _TABLE_M, _LYING[4:], 0.02)
    for low, high in ((left, w / 2 - 1.02), (w / 2 - 0.55, w / 2 - 0.1), (w / 2 + 0.5, right)):
        _strew(space, (low, back - 0.3), (high, back - 0.06), _TABLE_M, _STANDING, 0.02)
    _scatter(space, (left, front + 0.05), (right, back - 0.35), _TABLE_M, 110)
    space.box(
        (w / 2 - 0.2, back + 0.5),
        (1.4, 0.42, 0.85),
        {"kind": "sideboard", "yaw_deg": 180.0, "colour": "#3c322a"},
    )
    space.box((w / 2 + 0.95, back + 0.8), (0.5, 0.5, 0.95), {"kind": "chair", "yaw_deg": 20.0})
    shelve(space, 3)
    clutter_walls(space, 0.5, (1, 2))
    _along_axes(space, (w / 2 + draw.uniform(-0.25, 0.05), front - 0.2), 1.45)


def _along_axes(space: Space, base: Point, height: float) -> None:
    """To and fro along x, y and z in turn, as fr1/xyz does, looking the same way."""
    reach = 0.17
    for lap in range(4):
        for axis in (0, 1, 2):
            for way in (1.0, -1.0, 0.0):
                size = way * reach * space.draw.uniform(0.7, 1.2)
                at = (base[0] + (size if axis == 0 else 0), base[1] - (abs(size) if axis == 1 else 0))
                z = height + (size if axis == 2 else 0)
                space.go(at, (at[0] + 0.02 * lap, at[1] + 0.6), z=z, look_z=z - 0.52)


def add_kitchen(place: Place, draw: Draw) -> None:
    """Cupboards along two walls, a table with chairs between them and the camera."""
    w, d = 4.6, 4.2
    space = _room(
        place, draw, "kitchen", (w, d), [[w / 2 + x, d - y] for x in (-1.0, 1.0) for y in (1.7, 3.2)]
    )
    front = {"kind": draw.choose(("sideboard", "drawers")), "colour": "#6e2022"}
    for k in range(6):
        space.stand(2, 0.5 + 0.62 * k, (0.6, 0.58, 0.88), front)
    for k in range(4):
        space.stand(1, 0.7 + 0.62 * k, (0.6, 0.58, 0.88), front)
    for low, high in (((0.25, d - 0.55), (w - 0.7, d - 0.1)), ((w - 0.58, 0.5), (w - 0.1, 2.8))):
        _strew(space, low, high, 0.88, _STANDING, 0.5)
    space.box((w - 0.12, 0.6 * d), (1.0, 0.2, 0.6), {"kind": "screen", "z": 1.4, "yaw_deg": 90.0})
    space.box((0.55 * w, d - 0.12), (0.9, 0.2, 0.55), {"kind": "screen", "z": 1.45, "yaw_deg": 180.0})
    table = (0.5 * w, 0.47 * d)
    space.box(table, (1.7, 0.85, _TABLE_M), {"kind": "table", "colour": "#a47c4c"})
    _strew(
        space, (table[0] - 0.7, table[1] - 0.38), (table[0] + 0.7, table[1] + 0.3), _TABLE_M, _LYING[:5], 0.25
    )
    for x, y, yaw in ((-0.4, 0.62, 180.0), (0.45, 0.6, 170.0), (1.12, 0.0, 90.0)):
        space.box(
            (table[0] + x, table[1] + y),
            (0.44, 0.44, 0.92),
            {"kind": "chair", "colour": "#5a3e28", "yaw_deg": yaw},
        )
    clutter_walls(space, 0.14)
    x, y = table[0], table[1] - 0.75
    views = (
        ((x - 0.9, y), (x + 0.4, d), 0.75), ((x, y - 0.1), (w, 0.75 * d), 0.85),
        ((x + 0.6, y), (x + 0.2, d), 0.8), ((x + 0.2, y - 0.2), (x - 1.2, d), 0.9),
        ((x - 0.6, y), (x - 0.2, table[1] + 0.4), 0.7), ((x + 0.5, y - 0.1), (w, 0.5 * d), 0.8),
        ((x - 0.3, y), (0.3, 0.8 * d), 1.0), ((x + 0.3, y), (x + 0.1, d), 1.1),
    )  # fmt: skip
    for at, look, look_z in views:
        space.go(at, look, z=1.4 + draw.uniform(-0.1, 0.1), look_z=look_z)
