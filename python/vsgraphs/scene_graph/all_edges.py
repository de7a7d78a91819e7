"""The edges of a graph: what follows from its nodes, and the pairs of walls that the optimisation holds."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from vsgraphs.scene_graph.edges import Edge, node_key
from vsgraphs.scene_graph.kinds import KINDS, relations

if TYPE_CHECKING:
    from vsgraphs.scene_graph.graph import SceneGraph


def ordered(edges: Iterable[Edge]) -> list[Edge]:
    """By kind, then by the ids as numbers; each once."""
    kinds = {kind: place for place, kind in enumerate(relations())}

    def rank(edge: Edge) -> tuple[Any, ...]:
        via = -1 if edge.via is None else _number(edge.via)
        ids = _number(edge.source), _number(edge.target), via
        return kinds[edge.kind], *ids, edge.source, edge.target  # nodes of two kinds may have one number

    return sorted(set(edges), key=rank)


def edges_of(graph: SceneGraph, pairs: Iterable[Mapping[str, Any]] = ()) -> list[Edge]:
    """All edges that follow from the nodes, and the wall pairs of the optimisation.

    pairs: {"planes": [a, b], "relation": "parallel" | "perpendicular" | "wall_perpendicular_to_ground"}, of
    the last one the wall first.
    """
    edges = [edge for kind in KINDS for edge in edges_at(graph, kind.section)]
    known = relations()
    for pair in pairs:
        relation, (a, b) = known[str(pair["relation"])], map(int, pair["planes"])
        edges.append(relation.between(a, b) if relation.symmetric else relation.edge(a, node_key("plane", b)))
    return ordered(edges)


def edges_at(graph: SceneGraph, section: str) -> Iterator[Edge]:
    """The edges that follow from the nodes of one section."""
    kind = next(kind for kind in KINDS if kind.section == section)
    for node in graph.section(section).values():
        yield from kind.edges(node, graph)


def _number(key: str) -> int:
    return int(key.partition(":")[2])
