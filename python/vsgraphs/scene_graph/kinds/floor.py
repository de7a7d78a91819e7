"""Floors: storeys."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vsgraphs.scene_graph.kinds import rows
from vsgraphs.scene_graph.kinds.kind import Kind, SparkPlace, count
from vsgraphs.scene_graph.kinds.mover import Mover, Row, id_list, id_or_none
from vsgraphs.trajectory import Array

if TYPE_CHECKING:
    from vsgraphs.scene_graph.graph import SceneGraph


@dataclass(eq=False)
class FloorNode:
    """A storey: its rooms, the ground plane they stand on, and their middle."""

    id: int
    rooms: list[int]
    ground: int | None
    centroid: Array


class FloorKind(Kind[FloorNode]):
    """Its raw rows hold the same, in the map's frame."""

    name, section, node = "floor", "floors", FloorNode
    row = rows.row_of(
        {"id": rows.ID, "rooms": rows.IDS, "ground": rows.OPTIONAL_ID, "centroid": rows.VECTOR},
        description="A storey.",
    )
    colour = (220, 200, 140)
    spark = SparkPlace("buildings", "B")  # spark-dsg has no layer for storeys

    def from_map(self, row: Row, mover: Mover) -> FloorNode:
        centroid = mover.point(row["centroid"], f"floor {row['id']}: centroid")
        return FloorNode(row["id"], id_list(row.get("rooms", ())), id_or_none(row.get("ground")), centroid)

    def references(self, node: FloorNode) -> Iterator[tuple[str, int | None]]:
        yield from (("room", room) for room in node.rooms)
        yield "plane", node.ground

    def place(self, node: FloorNode) -> Array:
        return node.centroid

    def details(self, node: FloorNode) -> dict[str, Any]:
        return {"ground": node.ground}

    def figures(self, graph: SceneGraph) -> dict[str, Any]:
        return {"floors": len(graph.floors)}

    def found(self, figures: Mapping[str, Any]) -> str:
        return count(figures.get("floors", 0), "floor") or count(figures.get("grounds", 0), "ground plane")
