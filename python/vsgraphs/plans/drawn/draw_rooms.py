"""A flat or an office, and a walk through it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from vsgraphs.errors import InputError
from vsgraphs.plans.buildings.draw import Draw
from vsgraphs.plans.drawn.flat import add_flat
from vsgraphs.plans.drawn.offices import add_offices
from vsgraphs.plans.drawn.space import Place
from vsgraphs.plans.drawn.still_lifes import add_desk, add_kitchen
from vsgraphs.reading import shown

_MAKERS: dict[str, Callable[[Place, Draw], None]] = {
    "flat": add_flat, "office": add_offices, "desk": add_desk, "kitchen": add_kitchen,
}  # fmt: skip
DRAWN_KINDS = tuple(_MAKERS)
_STILL = {"desk": (0.45, 30.0), "kitchen": (0.4, 40.0)}  # one room, seen from the hand: m/s, deg/s
CARRIERS = ("hand", "robot")
_MAX_SEED = 2**63 - 1


def drawn(kind: str, seed: int = 0, *, carrier: str = "hand") -> dict[str, Any]:
    """A furnished flat or office with what makes real ones hard, and a walk through it, as a plan.

    Closed, half-open and framed doors, doors that move, doors as high as the room, pairs of doors, steps,
    glass walls, mirrors, windows with something behind them, shelves over whole walls, pillars, alcoves,
    sloped ceilings, round and bare rooms, dark rooms, people. Equal arguments give equal plans.

    Args:
      kind: "flat" or "office"; "desk" or "kitchen": a single room like a well-known recording.
      seed: draws everything, 0 to 2^63-1.
      carrier: "hand", or "robot": 0.3 m above the floor with the robot in view.

    Raises InputError naming the argument.
    """
    if kind not in DRAWN_KINDS:
        raise InputError(f"drawn must be one of {', '.join(DRAWN_KINDS)}, not {shown(kind)}")
    if carrier not in CARRIERS:
        raise InputError(f"carrier must be one of {', '.join(CARRIERS)}, not {shown(carrier)}")
    if isinstance(seed, bool) or not isinstance(seed, int) or not 0 <= seed <= _MAX_SEED:
        raise InputError(f"seed must be a whole number from 0 to {_MAX_SEED}, not {shown(seed)}")
    if kind in _STILL and carrier != "hand":
        raise InputError(f"a drawn {kind} is seen from the hand: leave the robot away")
    place, draw = Place(), Draw(seed, "drawn", kind)
    _MAKERS[kind](place, draw)
    site = place.site
    lists = {
        "rooms": site.rooms, "doors": site.doors, "windows": site.windows, "posters": site.posters,
        "boxes": site.boxes, "partitions": place.partitions, "movers": place.movers,
    }  # fmt: skip
    pace: dict[str, Any] = {"speed": 0.5, "turn_rate": 40.0, "clearance": 0.12, "closed": True}
    if kind in _STILL:
        pace |= {"speed": _STILL[kind][0], "turn_rate": _STILL[kind][1], "shake": 2.2, "clearance": 0.1}
    if carrier == "robot":
        pace |= {"eye_height": 0.3, "pitch_deg": 4.0, "shake": 0.15, "robot": {"below": 0.1}}
    return {
        "name": f"{kind}-{seed}",
        "description": f"A drawn {kind}, seed {seed}; every room that is open is walked through.",
        "seed": 1 + seed % 1_000_000,
        **{name: found for name, found in lists.items() if found},
        "path": {**pace, "waypoints": site.way()},
    }
