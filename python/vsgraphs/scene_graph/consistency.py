"""Whether every id that a node or an edge names is there, and every node can be one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vsgraphs.errors import InputError
from vsgraphs.reading import shown
from vsgraphs.scene_graph.kinds import KINDS

if TYPE_CHECKING:
    from vsgraphs.scene_graph.graph import SceneGraph


def check_references(graph: SceneGraph, source: str) -> None:
    """Raises InputError, which names `source`, at the first id that no node has."""
    there = {kind.name: graph.section(kind.section) for kind in KINDS}
    for kind in KINDS:
        for node in there[kind.name].values():
            for name, number in kind.references(node):
                if number is not None and number not in there[name]:
                    who = f"{kind.name} {node.id}"
                    raise InputError(f"{source}: {who} names {name} {number}, which is not there")


def check_nodes(graph: SceneGraph, source: str) -> None:
    """As above, for nodes that cannot be."""
    for kind in KINDS:
        for node in graph.section(kind.section).values():
            problem = kind.problem(node)
            if problem is not None:
                raise InputError(f"{source}: {kind.name} {node.id} {problem}")


def check_edges(graph: SceneGraph, source: str) -> None:
    """As above, for the ends of edges."""
    there = {kind.name: graph.section(kind.section) for kind in KINDS}
    for edge in graph.edges:
        for end in (edge.source, edge.target, edge.via):
            if end is None:
                continue
            kind, _, number = end.partition(":")
            if not number.isdecimal() or len(number) > 20 or int(number) not in there.get(kind, {}):
                raise InputError(
                    f"{source}: an edge {shown(edge.kind)} names {shown(end)}, which is not there"
                )
