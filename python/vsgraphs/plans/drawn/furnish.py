"""What stands and hangs in a drawn room."""

from __future__ import annotations

from vsgraphs.plans.buildings.site import Item
from vsgraphs.plans.drawn.space import GAP_M, Space

# kind, length along the wall, depth, height
_LOW = (
    ("sideboard", 1.4, 0.42, 0.8),
    ("drawers", 0.8, 0.45, 0.9),
    ("drawers", 0.5, 0.42, 0.65),
    ("table", 1.2, 0.6, 0.74),
    ("sideboard", 0.9, 0.38, 0.95),
)
_TALL = (
    ("bookshelf", 0.9, 0.3, 2.0),
    ("wardrobe", 1.2, 0.58, 2.05),
    ("bookshelf", 0.6, 0.28, 1.8),
    ("wardrobe", 0.8, 0.5, 2.0),
)
_SMALL = (
    ("plant", 0.34, 0.34, 1.1),
    ("floor_lamp", 0.3, 0.3, 1.6),
    ("parcel", 0.4, 0.34, 0.32),
    ("chair", 0.45, 0.45, 0.9),
    ("box", 0.35, 0.3, 0.28),
)
_ON_TOP = (
    ("books", 0.26, 0.2, 0.18),
    ("photo", 0.16, 0.03, 0.2),
    ("plant", 0.2, 0.2, 0.4),
    ("parcel", 0.26, 0.22, 0.18),
    ("screen", 0.5, 0.16, 0.4),
    ("box", 0.12, 0.1, 0.14),
)
# kind, width, height, lowest and highest middle above the floor
_FLAT = (
    ("poster", 0.6, 0.85, 1.4, 1.7),
    ("picture", 0.45, 0.35, 1.3, 1.9),
    ("picture", 0.8, 0.55, 1.4, 1.8),
    ("board", 0.9, 0.7, 1.4, 1.7),
    ("notice", 0.21, 0.3, 1.2, 1.8),
    ("notice", 0.42, 0.3, 1.1, 2.0),
    ("poster", 0.3, 0.42, 1.0, 1.9),
    ("board", 0.6, 0.45, 1.2, 1.8),
    ("clock", 0.3, 0.3, 1.8, 2.1),
    ("switch", 0.08, 0.08, 1.05, 1.1),
    ("socket", 0.08, 0.08, 0.3, 0.35),
)


def furnish(space: Space, crowd: float, walls: tuple[int, ...] = (1, 2, 3)) -> None:
    """Furniture along `walls`, things on it, things on the floor. crowd: 0 bare to 1 full."""
    for wall in walls:
        for _ in range(round(crowd * space.length(wall) / 0.7)):
            tall = space.draw.chance(0.4)
            kind, length, depth, height = space.draw.choose(_TALL if tall else _LOW)
            along = space.gap(space.stood[wall], wall, length + 0.1, 0.65)
            if along is not None and (not tall or _hides_nothing(space, wall, along, length)):
                _stand_with_clutter(space, wall, along, (kind, length, depth, height))
        for _ in range(round(2 * crowd)):
            kind, length, depth, height = space.draw.choose(_SMALL)
            along = space.gap(space.stood[wall], wall, length + 0.06, 0.65)
            if along is not None:
                space.stand(wall, along, (length, depth, height), {"kind": kind})


def _hides_nothing(space: Space, wall: int, along: float, length: float) -> bool:
    low, high = along - length / 2, along + length / 2
    return all(high < a or low > b for a, b in space.hung[wall])


def _stand_with_clutter(space: Space, wall: int, along: float, what: tuple[str, float, float, float]) -> None:
    kind, length, depth, height = what
    space.stand(wall, along, (length, depth, height), {"kind": kind})
    if height > 1.2:
        return
    place = along - length / 2 + 0.05
    while True:
        name, w, d, h = space.draw.choose(_ON_TOP)
        place += w / 2
        if place + w / 2 > along + length / 2:
            return
        if space.draw.chance(0.85):
            deep = GAP_M + depth / 2
            at = ((place, deep), (space.width - deep, place), (place, space.depth - deep), (deep, place))[
                wall
            ]
            yaw = (0.0, 90.0, 180.0, -90.0)[wall]
            space.box(at, (w, min(d, depth - 0.04), h), {"kind": name, "z": height, "yaw_deg": yaw})
        place += w / 2 + space.draw.uniform(0.01, 0.12)


def shelve(space: Space, wall: int) -> None:
    """Shelves over the whole wall, up to under the ceiling."""
    height, along = round(min(space.height - 0.15, 2.35), 2), 0.1
    while True:
        low, high = along, along + 0.9
        if high > space.length(wall) - 0.1:
            return
        if all(high < a or low > b for a, b in space.stood[wall]):
            space.stand(wall, along + 0.45, (0.9, 0.3, height), {"kind": "bookshelf"})
        along += 0.92


def clutter_walls(space: Space, crowd: float, walls: tuple[int, ...] = (0, 1, 2, 3)) -> None:
    """Pictures, boards, notices, switches, wherever nothing else is."""
    for wall in walls:
        for _ in range(round(4 * crowd * space.length(wall))):
            kind, width, height, low, high = space.draw.choose(_FLAT)
            z = space.draw.uniform(low, high)
            along = space.gap(space.hung[wall], wall, width)
            if along is not None and z + height / 2 < space.height - 0.1:
                space.hang(wall, along, {"kind": kind, "width": width, "height": height, "z": z})


def mirror(space: Space, wall: int) -> bool:
    """A mirror on a wall, if there is room for one."""
    width = space.draw.uniform(0.5, 1.1)
    along = space.gap(space.hung[wall], wall, width)
    if along is None:
        return False
    high = space.draw.uniform(0.7, 1.5)
    size: Item = {"kind": "mirror", "width": width, "height": high, "z": 1.35}
    space.hang(wall, along, size)
    return True
