"""What there is to say of one kind of node, said once for all that read, write, draw, count and score it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from vsgraphs.scene_graph.edges import Edge, Relation
from vsgraphs.scene_graph.kinds.box import Box
from vsgraphs.scene_graph.kinds.mover import Mover, Row
from vsgraphs.scene_graph.kinds.rows import Schema
from vsgraphs.trajectory import Array

if TYPE_CHECKING:
    from vsgraphs.scene_graph.graph import SceneGraph

Rgb = tuple[int, int, int]
NodeT = TypeVar("NodeT")


@dataclass(frozen=True)
class SparkPlace:
    """Where nodes of a kind stand in Spark-DSG.

    layer: "agents", "objects", "places", "rooms" or "buildings". symbol: the letter before their ids, of no
    other kind. labels: what nodes may be called in the layer's label space; none: they have no label.
    """

    layer: str
    symbol: str
    labels: tuple[str, ...] = ()


class Kind(ABC, Generic[NodeT]):
    """One kind of node. A subclass says what differs from these defaults.

    name: of one, as in "plane:3". section: of all, as in scene_graph.json. node: the dataclass; its fields
    are the row in the file. row: the schema of such a row; definitions: what it refers to. required: whether
    a file without the section is broken. derived: properties that a row tells beside the fields. relations:
    the kinds of edges it brings. boxed: whether the viewer draws it as its `box`, with its title, and, if
    in_plan, the plan too; others have drawings of their own there. truth: the list of scene_gt.json it is
    scored against, by its middle, which may be within_m off; None: it is not, or in a way of its own.
    """

    name: str
    section: str
    node: type[NodeT]
    row: Schema
    colour: Rgb
    spark: SparkPlace
    required: bool = False
    definitions: Mapping[str, Schema] = {}
    derived: tuple[str, ...] = ()
    relations: tuple[Relation, ...] = ()
    boxed: bool = False
    in_plan: bool = True
    truth: str | None = None
    within_m: float = 0.5

    # ---- from the map

    def rows(self, raw: Row) -> list[Row] | None:
        """Its raw rows in `snapshot.scene_graph()`; None: nobody looked for such nodes."""
        rows: list[Row] | None = raw.get(self.section)
        return rows

    @abstractmethod
    def from_map(self, row: Row, mover: Mover) -> NodeT | None:
        """A raw row as a node in the graph's frame; None: to be left out. Raises InputError."""

    def true_rows(self, document: Mapping[str, Any]) -> list[Mapping[str, Any]] | None:
        """What scene_gt.json lists of it: id, center, room; None: nothing that can be scored against."""
        rows: list[Mapping[str, Any]] | None = document.get(self.truth) if self.truth else None
        return rows

    # ---- what it has to do with others

    def references(self, node: NodeT) -> Iterator[tuple[str, int | None]]:
        """Kinds and ids of the nodes it names; None for an id is none."""
        yield from ()

    def edges(self, node: NodeT, graph: SceneGraph) -> Iterator[Edge]:
        """The edges that follow from the node."""
        yield from ()

    def parent(self, node: NodeT) -> tuple[str, int] | None:
        """Kind and id of what it is in: a room, a floor."""
        return None

    def children(self, node: NodeT) -> Iterator[tuple[str, int]]:
        """Kinds and ids of what is in it and does not say so itself."""
        yield from ()

    def neighbours(self, node: NodeT) -> list[int]:
        """Ids of nodes of its kind that are reached from it in a straight line."""
        return []

    def joins(self, node: NodeT) -> tuple[str, int, int] | None:
        """The kind and the ids of two nodes that one gets from the one to the other of through it."""
        return None

    def problem(self, node: NodeT) -> str | None:
        """What no such node can be, read from a file; for a message, as "has no cells"."""
        return None

    # ---- for pictures and other formats

    @abstractmethod
    def place(self, node: NodeT) -> Array:
        """(3,) where it is."""

    def title(self, node: NodeT, graph: SceneGraph) -> str:
        """What people call it."""
        return f"{self.name} {getattr(node, 'id')}"  # noqa: B009

    def label(self, node: NodeT) -> str | None:
        """Which of the labels of `spark` it has; None: none."""
        return next(iter(self.spark.labels), None)

    def rgb(self, node: NodeT) -> Rgb:
        """Its colour where nothing else colours it."""
        return self.colour

    def box(self, node: NodeT, graph: SceneGraph) -> Box | None:
        """How far it reaches; None: not known, or nowhere."""
        return None

    def rotation(self, node: NodeT) -> Array | None:
        """(3, 3) of its own axes; None: it has none."""
        return None

    def details(self, node: NodeT) -> dict[str, Any]:
        """What other formats have no field for; arrays and plain values."""
        return {}

    # ---- for people

    def figures(self, graph: SceneGraph) -> dict[str, Any]:
        """What run.json's section `scene` tells of all of them."""
        return {}

    def found(self, figures: Mapping[str, Any]) -> str:
        """As "2 rooms", from run.json's section `scene`, of this or an earlier version; empty for none."""
        return ""


def count(number: int, one: str, many: str = "") -> str:
    """As "1 room", "2 rooms"; empty for none. many: the plural; empty: with an s."""
    return f"{number} {one if number == 1 else many or one + 's'}" if number else ""
