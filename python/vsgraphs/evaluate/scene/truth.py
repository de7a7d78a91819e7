"""scene_gt.json: what a place really looks like. World z up, metres; see docs/simulator.md."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from vsgraphs.errors import InputError
from vsgraphs.evaluate.scene.truth_values import number_of, outline_of, point_of
from vsgraphs.reading import LARGE, read_json, shortened, shown
from vsgraphs.scene_graph import KINDS
from vsgraphs.trajectory import Array

_COPLANAR_M = 0.05


@dataclass(eq=False)
class TrueRoom:
    """polygon: (N, 2) counter-clockwise. required: must be found; others are neither hit nor false."""

    id: str
    polygon: Array
    z_floor: float
    height_m: float
    level: int
    required: bool


@dataclass(eq=False)
class TrueWall:
    """One face. start, end: (3,) on the floor. normal: (3,) into the room, normal . x + offset_m = 0."""

    id: str
    room: str
    start: Array
    end: Array
    height_m: float
    normal: Array
    required: bool

    @property
    def length_m(self) -> float:
        """Along the floor."""
        return float(np.linalg.norm(self.end - self.start))

    @property
    def along(self) -> Array:
        """(3,) unit vector from start to end."""
        along: Array = (self.end - self.start) / np.linalg.norm(self.end - self.start)
        return along

    @property
    def middle(self) -> Array:
        """(3,) the face's centre."""
        middle: Array = (self.start + self.end) / 2 + np.array([0.0, 0.0, self.height_m / 2])
        return middle


@dataclass(eq=False)
class TrueGround:
    """Coplanar floors of rooms."""

    id: str
    z: float
    rooms: list[TrueRoom]

    @property
    def required(self) -> bool:
        """Whether one of its rooms must be found."""
        return any(room.required for room in self.rooms)


@dataclass(eq=False)
class TrueDoor:
    """center: (3,) middle of the threshold. required: both rooms are."""

    id: str
    rooms: frozenset[str]
    center: Array
    required: bool


@dataclass(eq=False)
class TrueElement:
    """Anything else that is scored by its middle, center (3,). required: must be found."""

    id: str
    center: Array
    required: bool


@dataclass(eq=False)
class SceneTruth:
    """Everything that is scored. elements: by the name of their list, of those lists that are there."""

    rooms: list[TrueRoom]
    walls: list[TrueWall]
    grounds: list[TrueGround]
    doors: list[TrueDoor]
    elements: dict[str, list[TrueElement]] = field(default_factory=dict)

    def storeys(self) -> dict[int, list[TrueRoom]]:
        """Level -> its rooms."""
        levels: dict[int, list[TrueRoom]] = {}
        for room in self.rooms:
            levels.setdefault(room.level, []).append(room)
        return dict(sorted(levels.items()))


def load_scene_truth(path: Path) -> SceneTruth:
    """Reads scene_gt.json. Raises InputError."""
    return parse_scene_truth(read_json(path, "scene truth", LARGE), str(path))


def parse_scene_truth(document: Any, source: str) -> SceneTruth:
    """A parsed scene_gt.json; `source` names it in errors."""
    if not isinstance(document, Mapping) or "rooms" not in document or "walls" not in document:
        raise InputError(f"{source}: not a scene truth, it has no rooms and walls (see docs/simulator.md)")
    try:
        rooms = [_room(row) for row in document["rooms"]]
        required = {room.id: room.required for room in rooms}
        walls = [_wall(row) for row in document["walls"]]
        doors = [_door(row, required) for row in document.get("doors", ())]
        elements = _elements(document, required)
    except (KeyError, IndexError, TypeError, ValueError, AttributeError, OverflowError) as error:
        what = shortened(f"no {error}" if isinstance(error, KeyError) else str(error))
        raise InputError(f"{source}: broken scene truth: {what}") from None
    return SceneTruth(rooms, walls, _grounds(rooms), doors, elements)


def _room(row: Mapping[str, Any]) -> TrueRoom:
    return TrueRoom(
        id=str(row["id"]),
        polygon=outline_of(row["polygon"]),
        z_floor=number_of(row["z_floor"]),
        height_m=number_of(row["height"]),
        level=int(row.get("level", 0)),
        required=bool(row["counted"]) and bool(row["visited"]),
    )


def _wall(row: Mapping[str, Any]) -> TrueWall:
    wall = TrueWall(
        id=str(row["id"]),
        room=str(row["room"]),
        start=point_of(row["p0"]),
        end=point_of(row["p1"]),
        height_m=number_of(row["height"]),
        normal=point_of(row["n"]),
        required=bool(row["counted"]) and bool(row["observed"]),
    )
    if not wall.length_m or not wall.normal.any():
        raise ValueError(f"wall {shown(row['id'])} has no length or no normal")
    return wall


def _door(row: Mapping[str, Any], required: Mapping[str, bool]) -> TrueDoor:
    rooms = frozenset(map(str, row["rooms"]))
    return TrueDoor(
        id=str(row["id"]),
        rooms=rooms,
        center=point_of(row["center"]),
        required=all(required.get(room, False) for room in rooms),
    )


def _elements(document: Mapping[str, Any], required: Mapping[str, bool]) -> dict[str, list[TrueElement]]:
    """The lists that kinds of nodes are scored against, of those that tell middles.

    Rows: id, center, room (in which it is), and counted, observed as of walls; true where they are not told.
    """
    found: dict[str, list[TrueElement]] = {}
    for kind in KINDS:
        listed = kind.true_rows(document)
        if kind.truth is None or listed is None or not all("center" in row for row in listed):
            continue
        found[kind.truth] = [
            TrueElement(
                id=str(row["id"]),
                center=point_of(row["center"]),
                required=required.get(str(row["room"]), False)
                and all(bool(row.get(told, True)) for told in ("counted", "observed")),
            )
            for row in listed
        ]
    return found


def _grounds(rooms: list[TrueRoom]) -> list[TrueGround]:
    grounds: list[TrueGround] = []
    for room in sorted(rooms, key=lambda room: room.z_floor):
        if grounds and room.z_floor - grounds[-1].z < _COPLANAR_M:
            grounds[-1].rooms.append(room)
        else:
            grounds.append(TrueGround(f"ground at {room.z_floor:g} m", room.z_floor, [room]))
    return grounds
