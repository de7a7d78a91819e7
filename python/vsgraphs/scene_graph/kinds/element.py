"""Elements of the scene: what a room has or holds, as a box on planes, found by the map.

All kinds of elements are alike but for what they are called and how they look: a kind is a subclass of
`ElementKind` in a file of its own here, and a line in `table.py`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from vsgraphs.errors import InputError
from vsgraphs.reading import shown
from vsgraphs.scene_graph.edges import Edge, Relation, node_key
from vsgraphs.scene_graph.kinds import rows
from vsgraphs.scene_graph.kinds.box import Box
from vsgraphs.scene_graph.kinds.kind import Kind, count
from vsgraphs.scene_graph.kinds.mover import Mover, Row, finite, id_list
from vsgraphs.trajectory import Array

if TYPE_CHECKING:
    from vsgraphs.scene_graph.graph import SceneGraph

SHOWS = Relation("shows", "plane")  # plane -> the element that is seen on it


@dataclass(eq=False)
class ElementNode:
    """A thing in a box. kind: its kind's name. center: (3,) the box's middle.

    along: (3,) horizontal unit vector in which the box is wide. size_m: (3,) width, depth, height.
    planes: on which it is seen. rooms: in which it is; one between two rooms is in both.
    """

    id: int
    kind: str
    center: Array
    along: Array
    size_m: Array
    planes: list[int]
    rooms: list[int]


class ElementKind(Kind[ElementNode]):
    """A subclass says name, section, colour, spark and description (of a row, for the schema); of what `Kind`
    has beside these, in_plan, truth and within_m. Its raw rows are those of `elements` whose `kind` is the
    name.
    """

    node = ElementNode
    boxed = True
    description: str

    def __init__(self) -> None:
        self._lies_in = Relation("lies_in", self.name)  # element -> room; one kind of edge for all of them
        self.relations = (SHOWS, self._lies_in)
        self.row = rows.row_of(
            {
                "id": rows.ID,
                "kind": {"const": self.name},
                "center": rows.VECTOR,
                "along": rows.VECTOR,
                "size_m": rows.VECTOR,
                "planes": rows.IDS,
                "rooms": rows.IDS,
            },
            description=self.description,
        )

    def rows(self, raw: Row) -> list[Row] | None:
        elements = raw.get("elements")
        if elements is None or self.name not in raw.get("element_kinds", [self.name]):
            return None
        return [row for row in elements if row["kind"] == self.name]

    def from_map(self, row: Row, mover: Mover) -> ElementNode:
        what = f"{self.name} {row['id']}"
        along = mover.direction(row["along"], f"{what}: along")
        if abs(np.linalg.norm(along) - 1) > 1e-3:
            raise InputError(f"{what}: 'along' has length {np.linalg.norm(along):g}, expected 1")
        size_m = finite(np.array(row["size_m"], dtype=np.float64).reshape(3), f"{what}: size_m")
        if (size_m < 0).any():
            raise InputError(f"{what}: its size is {shown(size_m.tolist())}, at least 0 expected")
        center = mover.point(row["centre"], f"{what}: centre")
        planes, rooms = id_list(row.get("planes", ())), id_list(row.get("rooms", ()))
        return ElementNode(row["id"], self.name, center, along, size_m, planes, rooms)

    def references(self, node: ElementNode) -> Iterator[tuple[str, int | None]]:
        yield from (("plane", plane) for plane in node.planes)
        yield from (("room", room) for room in node.rooms)

    def edges(self, node: ElementNode, graph: SceneGraph) -> Iterator[Edge]:
        for plane in node.planes:
            yield SHOWS.edge(plane, node_key(self.name, node.id))
        for room in node.rooms:
            yield self._lies_in.edge(node.id, node_key("room", room))

    def parent(self, node: ElementNode) -> tuple[str, int] | None:
        return ("room", node.rooms[0]) if node.rooms else None

    def place(self, node: ElementNode) -> Array:
        return node.center

    def box(self, node: ElementNode, graph: SceneGraph) -> Box:
        up = np.array([0.0, -1.0, 0.0]) if graph.frame.up is None else graph.frame.up  # as cameras are held
        rotation = np.stack([node.along, np.cross(up, node.along), up], axis=1)
        return Box(node.center, node.size_m, rotation)

    def details(self, node: ElementNode) -> dict[str, Any]:
        return {"size_m": node.size_m, "along": node.along, "planes": node.planes, "rooms": node.rooms}

    def figures(self, graph: SceneGraph) -> dict[str, Any]:
        """Nothing where nobody looked."""
        sought = self.section in graph.estimated
        return {self.section: len(graph.section(self.section))} if sought else {}

    def found(self, figures: Mapping[str, Any]) -> str:
        return count(figures.get(self.section, 0), self.name, self.section)
