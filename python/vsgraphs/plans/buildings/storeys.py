"""Lines above one another, joined by straight stairs beside the corridor's far end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from vsgraphs.plans.buildings.draw import Draw
from vsgraphs.plans.buildings.office import DOOR_M, WALL_M, Storey
from vsgraphs.plans.buildings.order import Order
from vsgraphs.plans.buildings.site import Frame, Item, Point, Site
from vsgraphs.plans.buildings.wing import MIDDLE_M, Wing, row_length

RISE_M = 2.8  # from storey to storey
_HEIGHT_M = 2.6  # of rooms
_WELL_M = (7.4, 1.38)  # the stairs' room
_FOOT_M, _TOP_M = 6.5, 0.75  # middles of its doors, along wall 0
_FIRST_RISER_M, _LAST_RISER_M = 5.6, 1.5
_MIDDLE_M = _WELL_M[1] / 2

# x, height above the flight, kind, width, height: on the wall opposite the doors.
_PICTURES = (
    (6.4, 1.6, "poster", 0.55, 0.8),
    (5.2, 1.6, "notice", 0.3, 0.42),
    (4.2, 1.6, "board", 0.9, 0.75),
    (3.0, 1.5, "poster", 0.55, 0.8),
    (2.1, 1.5, "notice", 0.3, 0.42),
    (0.8, 1.5, "poster", 0.55, 0.8),
)


@dataclass(frozen=True)
class _Flight:
    """Stairs from a storey to the next. frame: as of an office; wing: the lower corridor."""

    name: str
    frame: Frame

    def build(self, site: Site, lower: Wing, upper: Wing, seed: int) -> None:
        w, d = _WELL_M
        z_floor = lower.storey.z_floor
        room: Item = {
            "id": self.name,
            "kind": "stairs",
            "polygon": [self.frame.point(corner) for corner in ((0, 0), (w, 0), (w, d), (0, d))],
            "floor": "concrete",
            "wall_colour": "#d4d0c8",
            "height": RISE_M + _HEIGHT_M,
            "counted": False,
            "brightness": 1.3,
            "lamps": [self.frame.point((x, _MIDDLE_M)) for x in (6.5, 4.4, 2.4, 0.7)],
            **lower.storey.keys(),
        }
        if z_floor == 0:
            room["z_floor"] = z_floor
        site.rooms.append(room)
        site.door(self.frame, (lower.name, self.name), (_FOOT_M, -WALL_M / 2))
        site.door(self.frame, (upper.name, self.name), (_TOP_M, -WALL_M / 2))
        flight: Item = {
            "room": self.name,
            "from": self.frame.point((_FIRST_RISER_M, _MIDDLE_M)),
            "to": self.frame.point((_LAST_RISER_M, _MIDDLE_M)),
            "width": round(d - 0.02, 3),
            "rise": RISE_M,
            "steps": 16,
            "landing": round(_LAST_RISER_M - 0.02, 3),
        }
        site.stairs.append(flight)
        self._hang(site, seed)

    def _hang(self, site: Site, seed: int) -> None:
        draw = Draw(seed, "stairs")  # every flight is hung alike
        run = _FIRST_RISER_M - _LAST_RISER_M
        for x, above, kind, width, height in _PICTURES:
            ground = RISE_M * min(1.0, max(0.0, (_FIRST_RISER_M - x) / run))
            hung = {"wall": 2, "along": round(_WELL_M[0] - x, 3), "z": round(ground + above, 3)}
            self._poster(site, hung, (kind, width, height), draw)
        for wall, along, z in (
            (1, _MIDDLE_M, 1.6),
            (3, _MIDDLE_M, RISE_M + 1.5),
            (0, 2.6, 3.8),
            (0, 4.2, 2.7),
        ):
            self._poster(site, {"wall": wall, "along": along, "z": z}, ("picture", 0.6, 0.6), draw)

    def _poster(self, site: Site, at: Item, shape: tuple[str, float, float], draw: Draw) -> None:
        kind, width, height = shape
        made = {"width": width, "height": height, "kind": kind, "seed": draw.seed()}
        site.posters.append({"room": self.name, **at, **made})

    def _go(self, site: Site, at: Point, look: Point, **more: float) -> None:
        site.go(self.frame, self.name, at, look, **more)

    def climb(self, site: Site, lower: Wing, upper: Wing) -> None:
        outside = -(WALL_M + MIDDLE_M)
        site.go(self.frame, lower.name, (_FOOT_M, outside), (_FOOT_M - 0.1, _WELL_M[1]))
        self._go(site, (6.4, 0.63), (3.2, 1.38))
        self._go(site, (5.7, 0.68), (0.0, 0.68), pitch_deg=8)
        self._go(site, (3.6, 0.68), (0.0, 0.6), pitch_deg=8)
        self._go(site, (1.5, 0.68), (0.0, 0.5))
        self._go(site, (0.8, 0.63), (_TOP_M - 0.1, 0.0))
        site.go(self.frame, upper.name, (_TOP_M, outside))

    def descend(self, site: Site, lower: Wing, upper: Wing) -> None:
        outside = -(WALL_M + MIDDLE_M)
        site.go(self.frame, upper.name, (_TOP_M, outside), (_TOP_M + 0.1, _WELL_M[1]))
        self._go(site, (0.85, 0.63), (3.2, 1.18))
        self._go(site, (1.5, 0.68), (7.4, 0.78), pitch_deg=-22)
        self._go(site, (3.6, 0.68), (7.4, 0.68), pitch_deg=-20)
        self._go(site, (5.7, 0.68), (7.4, 0.5))
        self._go(site, (6.4, 0.63), (_FOOT_M + 0.1, 0.0))
        site.go(self.frame, lower.name, (_FOOT_M, outside))


def build_storeys(order: Order, site: Site, hang: Callable[[Order, Wing, str], None]) -> None:
    """Every storey has the ground floor's layout; the flights stand on the left and on the right in turn."""
    ground = order.offices()
    rows = ground[::2], ground[1::2]
    start = round(max(map(row_length, rows)) + WALL_M, 3)
    wings, flights = [], []
    for level in range(order.storeys):
        storey = Storey(level, round(level * RISE_M, 3))
        wing = Wing(site, Frame(), f"C{level}", round(start + _WELL_M[0], 3), order.seed, storey)
        wing.build()
        offices = order.offices(level)
        wing.add_row("N", 0, offices[::2], "N")
        wing.add_row("S", 0, offices[1::2], "S")
        for side in "NS":  # the same on all storeys, whichever flights begin and end there
            for x in (_FOOT_M, _TOP_M):
                wing.keep_open(side, start + (x if side == "N" else _WELL_M[0] - x), DOOR_M)
        wings.append(wing)
    for level in range(order.storeys - 1):
        frame = wings[level].part("NS"[level % 2], start, _WELL_M[0])
        flights.append(_Flight(f"S{level}", frame))
        flights[level].build(site, wings[level], wings[level + 1], order.seed)
    for wing in wings:
        hang(order, wing, "01")
    _walk(order, site, wings, flights)


def _walk(order: Order, site: Site, wings: list[Wing], flights: list[_Flight]) -> None:
    draw = Draw(order.seed, "walk")
    wings[0].go(0.5, wings[0].length)
    for level, wing in enumerate(wings):
        if level:  # from the stairs to the other end first, so that all storeys are visited in the same order
            wing.go(0.8, 0.0)
            wing.go(1.0, wing.length)
        wing.visit_all(draw)
        if level < len(flights):
            flights[level].climb(site, wing, wings[level + 1])
    for level in reversed(range(len(flights))):
        flights[level].descend(site, wings[level], wings[level + 1])
    wings[0].go(0.8, 0.0)
