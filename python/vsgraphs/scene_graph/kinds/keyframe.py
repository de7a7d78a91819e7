"""Keyframes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from vsgraphs.scene_graph.kinds import rows
from vsgraphs.scene_graph.kinds.kind import Kind, SparkPlace
from vsgraphs.scene_graph.kinds.mover import Mover, Row
from vsgraphs.trajectory import Array


@dataclass(eq=False)
class KeyframeNode:
    """A camera pose of the map. world_from_camera: (4, 4), optical axes (x right, y down, z forward)."""

    id: int
    timestamp_s: float
    world_from_camera: Array


class KeyframeKind(Kind[KeyframeNode]):
    """Its raw rows hold the same, in the map's frame."""

    name, section, node = "keyframe", "keyframes", KeyframeNode
    required = True
    colour = (150, 150, 160)
    spark = SparkPlace("agents", "a")
    row = rows.row_of(
        {"id": rows.ID, "timestamp_s": rows.NUMBER, "world_from_camera": rows.TRANSFORM},
        description="A camera pose of the map, optical axes (x right, y down, z forward).",
    )

    def from_map(self, row: Row, mover: Mover) -> KeyframeNode:
        return KeyframeNode(row["id"], float(row["timestamp_s"]), mover.transform @ row["world_from_camera"])

    def place(self, node: KeyframeNode) -> Array:
        place: Array = node.world_from_camera[:3, 3]
        return place

    def rotation(self, node: KeyframeNode) -> Array:
        rotation: Array = node.world_from_camera[:3, :3]
        return rotation

    def details(self, node: KeyframeNode) -> dict[str, Any]:
        return {"timestamp_s": node.timestamp_s}
