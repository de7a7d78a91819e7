"""Buildings of offices that look alike, as plans."""

from __future__ import annotations

from typing import Any

from vsgraphs.errors import InputError
from vsgraphs.plans.buildings.furnishing import Density
from vsgraphs.plans.buildings.layouts import BUILDERS
from vsgraphs.plans.buildings.order import Order
from vsgraphs.plans.buildings.site import Site
from vsgraphs.reading import shown

BUILDING_KINDS = ("line", "ring", "star", "storeys")
MAX_ROOMS, MAX_STOREYS = 200, 20
_MAX_SEED = 2**63 - 1
_PACE = {"speed": 0.7, "turn_rate": 50.0}  # of somebody who walks through with a camera in the hand


def building(
    kind: str,
    rooms: int = 12,
    furnishings: int | None = None,
    seed: int = 0,
    *,
    storeys: int = 2,
    bareness: float = 0.0,
    furniture: float = 1.0,
    corridor_posters: bool = True,
) -> dict[str, Any]:
    """A building of offices, and a walk through each that comes back to its start, as a plan for `simulate`.

    Offices with the same furnishing are alike in size, furniture, pictures and colours, turned only; their
    doors stand in different places. Equal arguments give equal plans.

    Args:
      kind: "line" (a corridor with offices on both sides), "ring" (four corridors around a yard), "star"
        (corridors that meet in a hall) or "storeys" (lines above one another, joined by stairs).
      rooms: offices, 1 to 200; of storeys at least one each.
      furnishings: how many different ones there are, each about as often: 1 to `rooms`; at most 4 unless
        given. Storeys are furnished alike: there at most the rooms of a storey, a multiple of these, or
        `rooms`.
      seed: draws everything, 0 to 2^63-1.
      storeys: of kind "storeys", 2 to 20.
      bareness: share of pictures and posters left out, 0 to 1.
      furniture: share of the furniture that is there, 0 to 1.
      corridor_posters: whether posters like those of the offices hang in the corridors.

    Raises InputError naming the argument.
    """
    if kind not in BUILDING_KINDS:
        raise InputError(f"building must be one of {', '.join(BUILDING_KINDS)}, not {shown(kind)}")
    _whole("rooms", rooms, 1, MAX_ROOMS)
    floors = 1
    if kind == "storeys":
        _whole("storeys", storeys, 2, MAX_STOREYS)
        _whole("rooms", rooms, storeys, MAX_ROOMS)
        floors = storeys
    furnishings = min(4, -(-rooms // floors)) if furnishings is None else furnishings
    _whole("furnishings", furnishings, 1, rooms)
    _check_alike(rooms, furnishings, -(-rooms // floors))
    _whole("seed", seed, 0, _MAX_SEED)
    for name, share in (("bareness", bareness), ("furniture", furniture)):
        _number(name, share, 0, 1)
    density = Density(bareness, furniture)
    return _plan(Order(kind, rooms, furnishings, seed, floors, density, corridor_posters))


def _plan(order: Order) -> dict[str, Any]:
    site = Site(stacked=order.kind == "storeys")
    BUILDERS[order.kind](order, site)
    lists = ("rooms", "doors", "windows", "posters", "boxes", "stairs")
    return {
        "name": f"{order.kind}-{order.rooms}-{order.furnishings}-{order.seed}",
        "description": f"A generated building ({order.kind}) of {order.rooms} offices with "
        f"{order.furnishings} different furnishings, seed {order.seed}; every office is walked through.",
        "seed": order.seed,
        **{name: found for name in lists if (found := getattr(site, name))},
        "path": {**_PACE, "clearance": 0.15, "closed": True, "waypoints": site.way()},
    }


def _check_alike(rooms: int, furnishings: int, places: int) -> None:
    """places: of each storey."""
    if furnishings > places and furnishings % places and furnishings != rooms:
        raise InputError(
            f"furnishings must be at most {places} (the rooms of a storey), a multiple of that, or {rooms}, "
            f"not {furnishings}"
        )


def _whole(name: str, value: object, low: int, high: int) -> None:
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise InputError(f"{name} must be a whole number from {low} to {high}, not {shown(value)}")


def _number(name: str, value: object, low: float, high: float) -> None:
    if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
        raise InputError(f"{name} must be a number from {low} to {high}, not {shown(value)}")
