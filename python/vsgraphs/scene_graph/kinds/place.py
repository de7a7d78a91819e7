"""Places: points of free space."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vsgraphs.scene_graph.kinds import rows
from vsgraphs.scene_graph.kinds.kind import Kind, SparkPlace
from vsgraphs.scene_graph.kinds.mover import Mover, Row, id_list, id_or_none
from vsgraphs.trajectory import Array

if TYPE_CHECKING:
    from vsgraphs.scene_graph.graph import SceneGraph


@dataclass(eq=False)
class PlaceNode:
    """A point of free space, nothing nearer than clearance_m; neighbours are reached in a straight line."""

    id: int
    position: Array
    clearance_m: float
    room: int | None
    neighbours: list[int]


_ROW = rows.row_of(
    {
        "id": rows.ID,
        "position": rows.VECTOR,
        "clearance_m": rows.NUMBER,
        "room": rows.OPTIONAL_ID,
        "neighbours": rows.IDS,
    },
    description="A point of free space with nothing nearer than clearance_m.",
)


class PlaceKind(Kind[PlaceNode]):
    """Its raw rows hold the same, in the map's frame."""

    name, section, node = "place", "places", PlaceNode
    row = _ROW
    colour = (90, 90, 90)
    spark = SparkPlace("places", "p")

    def from_map(self, row: Row, mover: Mover) -> PlaceNode:
        position = mover.point(row["position"], f"place {row['id']}: position")
        room, neighbours = id_or_none(row.get("room")), id_list(row.get("neighbours", ()))
        return PlaceNode(row["id"], position, float(row["clearance_m"]), room, neighbours)

    def references(self, node: PlaceNode) -> Iterator[tuple[str, int | None]]:
        yield "room", node.room
        yield from (("place", other) for other in node.neighbours)

    def parent(self, node: PlaceNode) -> tuple[str, int] | None:
        return None if node.room is None else ("room", node.room)

    def neighbours(self, node: PlaceNode) -> list[int]:
        return node.neighbours

    def place(self, node: PlaceNode) -> Array:
        return node.position

    def title(self, node: PlaceNode, graph: SceneGraph) -> str:
        return ""

    def details(self, node: PlaceNode) -> dict[str, Any]:
        return {"clearance_m": node.clearance_m}
