"""How wings make a building, and the walk through it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from vsgraphs.plans.buildings.draw import Draw
from vsgraphs.plans.buildings.furnishing import Furnishing
from vsgraphs.plans.buildings.hall import Hall
from vsgraphs.plans.buildings.office import WALL_M
from vsgraphs.plans.buildings.order import Order
from vsgraphs.plans.buildings.site import Frame, Site
from vsgraphs.plans.buildings.storeys import build_storeys
from vsgraphs.plans.buildings.wing import CORRIDOR_M, MIDDLE_M, PASSAGE_M, Wing, row_length

_RING_M = 9.0  # side of the smallest ring


def _shared(order: Order, wings: int) -> list[list[Furnishing]]:
    """The offices of each wing, as evenly as can be."""
    offices = order.offices()
    counts = [order.rooms // wings + (i < order.rooms % wings) for i in range(wings)]
    starts = [sum(counts[:i]) for i in range(wings)]
    return [offices[start : start + count] for start, count in zip(starts, counts, strict=True)]


def _hang(order: Order, wing: Wing, ends: str) -> None:
    if order.corridor_posters:
        draw = Draw(order.seed, "corridor", "C" if wing.site.stacked else wing.name)  # storeys are alike
        wing.hang_posters(order.designs(), draw, bareness=order.density.bareness, ends=ends)


def build_line(order: Order, site: Site) -> None:
    """A corridor along x, offices on both sides."""
    offices = order.offices()
    north, south = offices[::2], offices[1::2]
    wing = Wing(site, Frame(), "C", max(row_length(north), row_length(south)), order.seed)
    wing.build()
    wing.add_row("N", 0, north, "N")
    wing.add_row("S", 0, south, "S")
    _hang(order, wing, "01")
    wing.go(0.5, wing.length)
    wing.visit_all(Draw(order.seed, "walk"))
    wing.turn_at_end()
    wing.go(0.8, 0.0)


def build_ring(order: Order, site: Site) -> None:
    """Four corridors around a square; each ends at the next one's side, so that all four are alike."""
    sides = [(side[: _outside(side)], side[_outside(side) :]) for side in _shared(order, 4)]
    across = CORRIDOR_M + WALL_M
    depth = max((f.depth for _, inside in sides for f in inside), default=0.0)
    lengths = [_RING_M]
    lengths += [row_length(outside) + across for outside, _ in sides]
    lengths += [row_length(inside) + depth + 2 * across + WALL_M for _, inside in sides if inside]
    length = round(max(lengths), 3)
    wings = []
    for number, (outside, inside) in enumerate(sides):
        x, y = ((0, 0), (length, 0), (length, length), (0, length))[number]
        wing = Wing(site, Frame(x, y, 90 * number), f"C{number}", length - across, order.seed)
        wing.build()
        spare = wing.length - row_length(outside)
        wing.add_row("S", round(spare / 2, 2), outside, f"R{number}S")
        wing.add_row("N", across, inside, f"R{number}N")
        wing.keep_open("N", MIDDLE_M, PASSAGE_M)
        wings.append(wing)
    for number, wing in enumerate(wings):
        joined = (wing.name, wings[(number + 1) % 4].name)
        site.door(wing.frame, joined, (wing.length + WALL_M / 2, MIDDLE_M), PASSAGE_M)
        _hang(order, wing, "0")
    _walk_ring(order, wings)


def _outside(side: Sequence[Furnishing]) -> int:
    """How many of a side's offices stand outside: all of few, then two of three."""
    return min(len(side), 4 + -(-(len(side) - 4) * 2 // 3)) if len(side) > 4 else len(side)


def _walk_ring(order: Order, wings: list[Wing]) -> None:
    draw = Draw(order.seed, "walk")
    first = wings[0]
    first.go(MIDDLE_M, first.length)
    for wing in wings:
        wing.visit_all(draw)
        wing.go(wing.length - 0.6, wing.length + MIDDLE_M)
        following = wings[(wings.index(wing) + 1) % 4]
        following.go(MIDDLE_M, following.length)
    # Once more along the first corridor, as it was seen in the beginning, and back.
    first.go(first.length / 2, first.length)
    first.go(first.length / 2 - 0.2, 0.0)


def build_star(order: Order, site: Site) -> None:
    """Three to five corridors from a hall; few rooms: three."""
    arms = 3 if order.rooms < 8 else 4 if order.rooms < 24 else 5
    shared = [offices for offices in _shared(order, arms) if offices]
    hall = Hall(site, arms, len(shared), order.seed)
    hall.build(order.density)
    depth = max(f.depth for offices in shared for f in offices)
    half = CORRIDOR_M / 2 + WALL_M + depth + WALL_M  # of a wing with its offices
    start = max(0.3, half / math.tan(math.pi / arms) + 0.2 - hall.reach)
    wings = []
    for number, offices in enumerate(shared):
        rows = offices[::2], offices[1::2]
        length = round(start + max(map(row_length, rows)), 3)
        wing = Wing(site, hall.arm(number), f"C{number}", length, order.seed)
        wing.build()
        for side, row in zip("NS", rows, strict=True):
            wing.add_row(side, start, row, f"A{number}{side}")
        site.door(wing.frame, (hall.name, wing.name), (-WALL_M / 2, MIDDLE_M), PASSAGE_M)
        _hang(order, wing, "1")
        wings.append(wing)
    hall.look_around()
    draw = Draw(order.seed, "walk")
    for wing in wings:
        wing.go(0.6, wing.length)
        wing.visit_all(draw)
        wing.turn_at_end()
        wing.go(0.6, -hall.reach)
        hall.cross()


BUILDERS: dict[str, Callable[[Order, Site], None]] = {
    "line": build_line,
    "ring": build_ring,
    "star": build_star,
    "storeys": lambda order, site: build_storeys(order, site, _hang),
}
