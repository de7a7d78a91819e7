"""How an office is furnished: everything in it, in a frame of its own, so that offices can be alike.

The frame of an office, as somebody sees it who comes in: the origin is the left corner of the door's wall, x
runs along that wall to the right, y into the room; walls 0 to 3 are the door's, the right one, the window's,
the left one.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from vsgraphs.plans.buildings.draw import Draw
from vsgraphs.plans.buildings.site import Item

SIZES_M = ((3.5, 4.2), (3.8, 4.2), (4.1, 4.2), (3.8, 4.6), (4.4, 4.6))  # along the corridor, across
_FLOORS = ("tiles", "wood", "tiles", "carpet")
_WALLS = ("#cdd2c8", "#d2cdc2", "#c8ced2", "#d4d0c6")
_GAP_M = 0.02  # to the wall: skirting boards are 1.4 cm thick
_FRONT_M = 0.9  # nothing stands nearer to the door's wall
_TALL_M = 1.0  # what is higher hides what hangs behind it
_WAY_END_M = 2.5  # the camera goes no deeper into the room

# kind, length along the wall, depth, height
_TALL = (
    ("bookshelf", 1.0, 0.32, 1.9),
    ("bookshelf", 0.8, 0.3, 2.0),
    ("wardrobe", 1.0, 0.55, 2.0),
    ("bookshelf", 1.2, 0.36, 1.7),
)
_LOW = (
    ("sideboard", 1.2, 0.42, 0.8),
    ("drawers", 0.8, 0.45, 0.9),
    ("drawers", 0.6, 0.45, 0.7),
    ("sideboard", 1.0, 0.4, 0.9),
)
_ON_TOP = (
    ("plant", 0.24, 0.24, 0.5),
    ("parcel", 0.32, 0.25, 0.22),
    ("books", 0.3, 0.22, 0.2),
    ("photo", 0.16, 0.03, 0.22),
)
_IN_CORNERS = (
    ("plant", 0.36, 0.36, 1.1),
    ("floor_lamp", 0.3, 0.3, 1.6),
    ("parcel", 0.38, 0.32, 0.3),
    ("plant", 0.34, 0.34, 1.3),
)
# kind, width, height, height of the middle
_PICTURES = (
    ("poster", 0.55, 0.8, 1.55),
    ("board", 0.9, 0.75, 1.6),
    ("picture", 0.7, 0.5, 1.6),
    ("notice", 0.3, 0.42, 1.5),
    ("clock", 0.34, 0.34, 1.8),
)


@dataclass(frozen=True)
class Density:
    """bareness: share of pictures left out; furniture: share of furniture that is there. Both 0 to 1."""

    bareness: float = 0.0
    furniture: float = 1.0


@dataclass
class Furnishing:
    """Of an office. width: along the corridor; depth: across, metres. Boxes, walls: in the office's frame."""

    width: float
    depth: float
    floor: str
    wall_colour: str
    window: Item
    boxes: list[Item] = field(default_factory=list)
    posters: list[Item] = field(default_factory=list)
    beside_door: Item | None = None  # hangs on wall 0, wherever the door leaves room


def make_furnishing(seed: int, number: int, size_number: int, density: Density) -> Furnishing:
    """Furnishing `number` of building `seed`; equal arguments give equal furnishings."""
    draw = Draw(seed, "furnishing", number)
    width, depth = Draw(seed, "size", size_number).choose(SIZES_M)
    floor, colour = draw.choose(_FLOORS), draw.choose(_WALLS)
    window = {"width": draw.choose((1.2, 1.4, 1.6)), "radiator": True, "curtain": draw.chance(0.5)}
    made = Furnishing(width, depth, floor, colour, {**window, "seed": draw.seed()})
    _Furnisher(draw, made, density).furnish()
    return made


class _Furnisher:
    def __init__(self, draw: Draw, into: Furnishing, density: Density) -> None:
        self._draw, self._into, self._density = draw, into, density
        self._taken: list[tuple[float, float, float, float]] = []  # x0, y0, x1, y1 on the floor
        self._hidden: dict[str, list[tuple[float, float]]] = {"left": [], "right": []}  # of walls, in y

    def furnish(self) -> None:
        """Draws everything in the same order whatever is left out."""
        desk_side, shelf_side = self._draw.shuffled(("left", "right"))
        nearest = self._desk(desk_side)
        self._low(desk_side, _FRONT_M, nearest - 0.15)
        self._shelves(shelf_side)
        self._corners()
        for side in ("right", "left"):
            self._pictures(side)
        hung = {"kind": "picture", "width": 0.6, "height": 0.6, "z": 1.6, "seed": self._draw.seed()}
        if self._hangs():
            self._into.beside_door = hung

    def _stands(self) -> bool:
        return self._draw.chance(self._density.furniture)

    def _hangs(self) -> bool:
        return not self._draw.chance(self._density.bareness)

    def _put(
        self,
        side: str,
        piece: tuple[str, float, float, float],
        y: float,
        *,
        there: bool,
        away: float = _GAP_M,
    ) -> Item:
        """A piece with its back to a side wall, its middle at y."""
        kind, length, deep, high = piece
        x = away + deep / 2
        item: Item = {
            "kind": kind,
            "at": (round(x if side == "left" else self._into.width - x, 3), round(y, 3)),
            "size": [length, deep, high],
            "yaw_deg": -90.0 if side == "left" else 90.0,
            "seed": self._draw.seed(),
        }
        if there:
            self._into.boxes.append(item)
            px, py = item["at"]
            self._taken.append((px - deep / 2, py - length / 2, px + deep / 2, py + length / 2))
            if high > _TALL_M:
                self._hidden[side].append((py - length / 2, py + length / 2))
        return item

    def _desk(self, side: str) -> float:
        """Table, screen, chair at the window's end; returns where the table begins."""
        length = self._draw.choose((1.3, 1.5))
        y = self._draw.uniform(_WAY_END_M + 0.5, self._into.depth - 0.1 - length / 2)
        there = self._stands()
        self._put(side, ("table", length, 0.7, 0.74), y, there=there, away=0.05)
        screen = self._put(
            side, ("screen", 0.55, 0.16, 0.42), y + self._draw.uniform(-0.1, 0.1), there=there, away=0.2
        )
        screen["z"] = 0.74
        chair = self._put(
            side, ("chair", 0.44, 0.44, 0.9), y + self._draw.uniform(-0.05, 0.05), there=there, away=0.82
        )
        chair["yaw_deg"] += 180 + self._draw.uniform(-12, 12)  # looks at the table
        return y - length / 2

    def _low(self, side: str, low: float, high: float) -> None:
        fitting = [piece for piece in _LOW if piece[1] <= high - low]
        piece = self._draw.choose(fitting or _LOW[2:3])
        there = self._stands() and bool(fitting)
        y = self._draw.uniform(low + piece[1] / 2, max(low, high - piece[1] / 2))
        self._put(side, piece, y, there=there)
        kind, length, deep, tall = self._draw.choose(_ON_TOP)
        along = self._draw.uniform(-1, 1) * max(0, piece[1] / 2 - length / 2 - 0.05)
        if self._stands() and there:
            away = _GAP_M + piece[2] / 2 - deep / 2
            self._put(side, (kind, length, deep, tall), y + along, there=True, away=away)["z"] = piece[3]

    def _shelves(self, side: str) -> None:
        """A tall piece and a low one, in either order."""
        tall = self._draw.choose(_TALL)
        first = self._draw.chance(0.5)
        at_window = self._into.depth - 0.1 - tall[1] / 2 - self._draw.uniform(0, 0.35)
        y = at_window if first else _FRONT_M + tall[1] / 2 + self._draw.uniform(0, 0.3)
        self._put(side, tall, y, there=self._stands())
        if first:
            self._low(side, _FRONT_M, y - tall[1] / 2 - 0.2)
        else:
            self._low(side, y + tall[1] / 2 + 0.2, self._into.depth - 0.1)

    def _corners(self) -> None:
        """Small things where there is room left."""
        w, d = self._into.width, self._into.depth
        spots = [("left", d - 0.3), ("right", d - 0.3), ("left", _FRONT_M + 0.2), ("right", _FRONT_M + 0.2)]
        spots += [(side, y) for side in ("left", "right") for y in (1.6, 2.2, 2.8)]
        for _ in range(2):
            piece = self._draw.choose(_IN_CORNERS)
            there = self._stands()
            for side, y in self._draw.shuffled(spots):
                x = _GAP_M + piece[2] / 2 if side == "left" else w - _GAP_M - piece[2] / 2
                if self._free(x, y, piece[2] / 2 + 0.08, piece[1] / 2 + 0.08):
                    self._put(side, piece, y, there=there)
                    break

    def _free(self, x: float, y: float, half_x: float, half_y: float) -> bool:
        return all(
            x + half_x < x0 or x - half_x > x1 or y + half_y < y0 or y - half_y > y1
            for x0, y0, x1, y1 in self._taken
        )

    def _pictures(self, side: str) -> None:
        """Two on a side wall, where nothing tall stands before it."""
        taken = [(low - 0.05, high + 0.05) for low, high in self._hidden[side]]
        for kinds in (_PICTURES[:2], _PICTURES):
            kind, width, height, z = self._draw.choose(kinds)
            seed, hangs = self._draw.seed(), self._hangs()
            y = self._gap(taken, width)
            if y is None:
                continue
            taken.append((y - width / 2 - 0.15, y + width / 2 + 0.15))
            along = y if side == "right" else self._into.depth - y
            hung = {"wall": 1 if side == "right" else 3, "along": round(along, 3), "z": z}
            if hangs:
                self._into.posters.append(
                    {**hung, "width": width, "height": height, "kind": kind, "seed": seed}
                )

    def _gap(self, taken: list[tuple[float, float]], width: float) -> float | None:
        """The middle of a free stretch of a side wall, drawn."""
        edges = sorted([(0.0, 0.3), (self._into.depth - 0.3, self._into.depth), *taken])
        free, reached = [], 0.0
        for low, high in edges:
            if low - reached > width:
                free.append((reached + width / 2, low - width / 2))
            reached = max(reached, high)
        share = self._draw.uniform(0, 1)
        if not free:
            return None
        low, high = self._draw.choose(free)
        return round(low + share * (high - low), 3)
