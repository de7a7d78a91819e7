"""Doors: openings between rooms."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vsgraphs.scene_graph.colours import CLASS_COLOURS
from vsgraphs.scene_graph.edges import Edge, Relation, node_key
from vsgraphs.scene_graph.kinds import rows
from vsgraphs.scene_graph.kinds.kind import Kind, SparkPlace, count
from vsgraphs.scene_graph.kinds.mover import Mover, Row, id_or_none, number_or_none
from vsgraphs.trajectory import Array

if TYPE_CHECKING:
    from vsgraphs.scene_graph.graph import SceneGraph

DOOR = Relation("door", "room", symmetric=True, via="door")


@dataclass(eq=False)
class DoorNode:
    """An opening between two rooms; the second is None while nobody has seen what lies behind it.

    center: (3,) middle of the threshold. normal: (3,) horizontal unit vector through the opening.
    kind: "door" (with a leaf or frame) or "passage". name: by a marker; empty: none.
    """

    id: int
    rooms: tuple[int | None, int | None]
    center: Array
    width_m: float
    height_m: float | None
    normal: Array
    kind: str
    name: str = ""


_ROW = rows.row_of(
    {
        "id": rows.ID,
        "rooms": {"type": "array", "items": rows.OPTIONAL_ID, "minItems": 2, "maxItems": 2},
        "center": rows.VECTOR,
        "width_m": rows.NUMBER,
        "height_m": rows.NUMBER_OR_NULL,
        "normal": rows.VECTOR,
        "kind": {"enum": ["door", "passage"]},
        "name": rows.TEXT,
    },
    optional=("name",),
    description="An opening. center: middle of the threshold; rooms: the second is null while unknown; name: "
    "by a marker, empty or absent: none.",
)


class DoorKind(Kind[DoorNode]):
    """Its raw rows hold the same, in the map's frame."""

    name, section, node = "door", "doors", DoorNode
    row = _ROW
    relations = (DOOR,)
    colour = CLASS_COLOURS["door"]
    spark = SparkPlace("objects", "D", ("doorway",))  # "door" is the plane of a closed leaf

    def from_map(self, row: Row, mover: Mover) -> DoorNode:
        what = f"door {row['id']}"
        first, second = row["rooms"]
        return DoorNode(
            id=row["id"],
            rooms=(id_or_none(first), id_or_none(second)),
            center=mover.point(row["center"], f"{what}: center"),
            width_m=float(row["width_m"]),
            height_m=number_or_none(row.get("height_m")),
            normal=mover.direction(row["normal"], f"{what}: normal"),
            kind=str(row.get("kind") or "door"),
            name=str(row.get("name") or ""),
        )

    def references(self, node: DoorNode) -> Iterator[tuple[str, int | None]]:
        yield from (("room", room) for room in node.rooms)

    def edges(self, node: DoorNode, graph: SceneGraph) -> Iterator[Edge]:
        first, second = node.rooms
        if first is not None and second is not None:
            yield DOOR.between(first, second, node_key("door", node.id))

    def parent(self, node: DoorNode) -> tuple[str, int] | None:
        return next((("room", room) for room in node.rooms if room is not None), None)

    def joins(self, node: DoorNode) -> tuple[str, int, int] | None:
        first, second = node.rooms
        return None if first is None or second is None else ("room", first, second)

    def place(self, node: DoorNode) -> Array:
        return node.center

    def title(self, node: DoorNode, graph: SceneGraph) -> str:
        return node.name or f"{node.kind} {node.id}"

    def details(self, node: DoorNode) -> dict[str, Any]:
        return {
            "rooms": list(node.rooms),
            "width_m": node.width_m,
            "height_m": node.height_m,
            "normal": node.normal,
            "kind": node.kind,
        }

    def figures(self, graph: SceneGraph) -> dict[str, Any]:
        return {"doors": len(graph.doors)}

    def found(self, figures: Mapping[str, Any]) -> str:
        return count(figures.get("doors", 0), "door")
