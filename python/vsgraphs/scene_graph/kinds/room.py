"""Rooms and corridors."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from vsgraphs.scene_graph.edges import Edge, Relation, node_key
from vsgraphs.scene_graph.kinds import rows
from vsgraphs.scene_graph.kinds.box import Box
from vsgraphs.scene_graph.kinds.kind import Kind, SparkPlace, count
from vsgraphs.scene_graph.kinds.mover import Mover, Row, id_list, id_or_none, number_or_none
from vsgraphs.scene_graph.kinds.plane import ON_GROUND
from vsgraphs.trajectory import Array

if TYPE_CHECKING:
    from vsgraphs.scene_graph.graph import SceneGraph

BOUNDS = Relation("bounds", "plane", "room_centroid")  # wall -> room
GROUND_OF = Relation("ground_of", "plane")  # ground -> room
BELONGS_TO = Relation("belongs_to", "room", "floor_centroid")  # room -> floor


@dataclass(eq=False)
class RoomNode:
    """A room or corridor. polygon: (N, 3) on its floor, counter-clockwise seen from above.

    partial: not all of its walls were seen. height_m: None where no ceiling was seen.
    """

    id: int
    name: str
    kind: str
    walls: list[int]
    ground: int | None
    polygon: Array
    centroid: Array
    height_m: float | None
    area_m2: float
    partial: bool
    floor: int | None


_ROW = rows.row_of(
    {
        "id": rows.ID,
        "name": rows.TEXT,
        "kind": {"enum": ["room", "corridor"]},
        "walls": rows.IDS,
        "ground": rows.OPTIONAL_ID,
        "polygon": rows.POINTS,
        "centroid": rows.VECTOR,
        "height_m": rows.NUMBER_OR_NULL,
        "area_m2": rows.NUMBER,
        "partial": rows.BOOLEAN,
        "floor": rows.OPTIONAL_ID,
    },
    description="polygon: on the room's floor, counter-clockwise from above.",
)


class RoomKind(Kind[RoomNode]):
    """Its raw rows hold the same, in the map's frame."""

    name, section, node = "room", "rooms", RoomNode
    row = _ROW
    relations = (BOUNDS, GROUND_OF, BELONGS_TO)
    colour = (140, 180, 220)
    spark = SparkPlace("rooms", "R", ("room", "corridor"))

    def from_map(self, row: Row, mover: Mover) -> RoomNode:
        what = f"room {row['id']}"
        return RoomNode(
            id=row["id"],
            name=str(row.get("name") or ""),
            kind=str(row.get("kind") or "room"),
            walls=id_list(row.get("walls", ())),
            ground=id_or_none(row.get("ground")),
            polygon=mover.points(row["polygon"], f"{what}: polygon"),
            centroid=mover.point(row["centroid"], f"{what}: centroid"),
            height_m=number_or_none(row.get("height_m")),
            area_m2=float(row["area_m2"]),
            partial=bool(row.get("partial", False)),
            floor=id_or_none(row.get("floor")),
        )

    def references(self, node: RoomNode) -> Iterator[tuple[str, int | None]]:
        yield from (("plane", wall) for wall in node.walls)
        yield "plane", node.ground
        yield "floor", node.floor

    def edges(self, node: RoomNode, graph: SceneGraph) -> Iterator[Edge]:
        key = node_key("room", node.id)
        for wall in node.walls:
            yield BOUNDS.edge(wall, key)
        if node.ground is not None:
            yield GROUND_OF.edge(node.ground, key)
            for wall in node.walls:
                yield ON_GROUND.edge(wall, node_key("plane", node.ground))
        if node.floor is not None:
            yield BELONGS_TO.edge(node.id, node_key("floor", node.floor))

    def parent(self, node: RoomNode) -> tuple[str, int] | None:
        return None if node.floor is None else ("floor", node.floor)

    def children(self, node: RoomNode) -> Iterator[tuple[str, int]]:
        yield from (("plane", wall) for wall in node.walls)
        if node.ground is not None:
            yield "plane", node.ground

    def place(self, node: RoomNode) -> Array:
        return node.centroid

    def title(self, node: RoomNode, graph: SceneGraph) -> str:
        return node.name or f"room {node.id}"

    def label(self, node: RoomNode) -> str:
        return node.kind

    def box(self, node: RoomNode, graph: SceneGraph) -> Box | None:
        if not len(node.polygon):
            return None
        low, high = node.polygon.min(axis=0), node.polygon.max(axis=0)
        if node.height_m is not None:
            high = high + np.array([0.0, 0.0, node.height_m])
        return Box((low + high) / 2, high - low)

    def details(self, node: RoomNode) -> dict[str, Any]:
        return {
            "kind": node.kind,
            "polygon": node.polygon,
            "area_m2": node.area_m2,
            "height_m": node.height_m,
            "walls": node.walls,
            "ground": node.ground,
            "partial": node.partial,
        }

    def figures(self, graph: SceneGraph) -> dict[str, Any]:
        rooms = graph.rooms.values()
        partial, area_m2 = sum(room.partial for room in rooms), sum(room.area_m2 for room in rooms)
        return {"rooms": len(rooms), "partial_rooms": partial, "area_m2": area_m2}

    def found(self, figures: Mapping[str, Any]) -> str:
        rooms = count(figures.get("rooms", 0), "room")
        if rooms and figures.get("partial_rooms"):
            some = "" if figures["partial_rooms"] == figures["rooms"] else f"{figures['partial_rooms']} "
            rooms += f" ({some}partly seen)"
        return rooms
