"""ArUco markers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vsgraphs.scene_graph.edges import Edge, Relation, node_key
from vsgraphs.scene_graph.kinds import rows
from vsgraphs.scene_graph.kinds.kind import Kind, SparkPlace
from vsgraphs.scene_graph.kinds.mover import Mover, Row, id_or_none
from vsgraphs.trajectory import Array

if TYPE_CHECKING:
    from vsgraphs.scene_graph.graph import SceneGraph

OBSERVES_MARKER = Relation("observes_marker", "keyframe", "marker")
NAMES = Relation("names", "marker")  # marker -> room or door


@dataclass(eq=False)
class MarkerNode:
    """An ArUco marker. id: the printed one. world_from_marker: (4, 4), x to the right of who reads it, y up,
    z out of the paper. name: of what it names, empty: nothing. room: where it hangs; door: which it names.
    """

    id: int
    name: str
    world_from_marker: Array
    size_m: float
    observed_by: list[int]
    room: int | None
    door: int | None = None


_ROW = rows.row_of(
    {
        "id": rows.ID,
        "name": rows.TEXT,
        "world_from_marker": rows.TRANSFORM,
        "size_m": rows.NUMBER,
        "observed_by": rows.IDS,
        "room": rows.OPTIONAL_ID,
        "door": rows.OPTIONAL_ID,
    },
    optional=("door",),
    description="An ArUco marker; id: the printed one; name: of what it names, empty: nothing; room: where "
    "it hangs; door: which it names.",
)


class MarkerKind(Kind[MarkerNode]):
    """Its raw rows hold the same, in the map's frame, and `in_two_places`: such are left out."""

    name, section, node = "marker", "markers", MarkerNode
    row = _ROW
    relations = (OBSERVES_MARKER, NAMES)
    colour = (220, 60, 60)
    spark = SparkPlace("objects", "M", ("marker",))

    def from_map(self, row: Row, mover: Mover) -> MarkerNode | None:
        if row.get("in_two_places", False):
            return None  # nobody knows where it is
        return MarkerNode(
            id=row["id"],
            name=str(row.get("name") or ""),
            world_from_marker=mover.pose(row["world_from_marker"], f"marker {row['id']}"),
            size_m=float(row["size_m"]),
            observed_by=mover.observers(row),
            room=id_or_none(row.get("room")),
            door=id_or_none(row.get("door")),
        )

    def references(self, node: MarkerNode) -> Iterator[tuple[str, int | None]]:
        yield "room", node.room
        yield "door", node.door
        yield from (("keyframe", number) for number in node.observed_by)

    def edges(self, node: MarkerNode, graph: SceneGraph) -> Iterator[Edge]:
        """A marker without a name names nothing."""
        for keyframe in node.observed_by:
            yield OBSERVES_MARKER.edge(keyframe, node_key("marker", node.id))
        if node.name and node.door is not None:
            yield NAMES.edge(node.id, node_key("door", node.door))
        elif node.name and node.room is not None:
            yield NAMES.edge(node.id, node_key("room", node.room))

    def parent(self, node: MarkerNode) -> tuple[str, int] | None:
        return None if node.room is None else ("room", node.room)

    def place(self, node: MarkerNode) -> Array:
        place: Array = node.world_from_marker[:3, 3]
        return place

    def title(self, node: MarkerNode, graph: SceneGraph) -> str:
        return node.name or f"marker {node.id}"

    def rotation(self, node: MarkerNode) -> Array:
        rotation: Array = node.world_from_marker[:3, :3]
        return rotation

    def details(self, node: MarkerNode) -> dict[str, Any]:
        return {
            "aruco_id": node.id,
            "size_m": node.size_m,
            "observed_by": node.observed_by,
            "room": node.room,
            "door": node.door,
        }
