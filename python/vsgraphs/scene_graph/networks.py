"""A scene graph for networkx."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any

from vsgraphs.errors import InputError
from vsgraphs.scene_graph.edges import node_key
from vsgraphs.scene_graph.kinds import KINDS, relations

if TYPE_CHECKING:
    from vsgraphs.scene_graph.graph import SceneGraph


def to_networkx(graph: SceneGraph) -> Any:
    """networkx.MultiDiGraph; nodes are named "plane:3" and carry `kind` and the dataclass's fields.

    Edges carry `kind` (their key, with "/door:N" for doors), `factor`, `via`; symmetric ones are there in
    both directions, so that paths can be searched. Places are joined by edges of kind "free". Raises
    InputError where networkx is not installed.
    """
    try:
        import networkx
    except ImportError:
        raise InputError(
            "networkx is not installed; install it with: pip install 'vsgraphs[graph]'"
        ) from None
    out = networkx.MultiDiGraph(levelled=graph.frame.levelled, world_from_map=graph.frame.world_from_map)
    for kind in KINDS:
        for node in graph.section(kind.section).values():
            values = {f.name: getattr(node, f.name) for f in fields(node) if f.name != "kind"}
            if hasattr(node, "kind"):
                values["subtype"] = node.kind  # "corridor", "passage"
            out.add_node(node_key(kind.name, node.id), kind=kind.name, **values)
    symmetric = {name for name, relation in relations().items() if relation.symmetric}
    for edge in graph.edges:
        key = edge.kind if edge.via is None else f"{edge.kind}/{edge.via}"
        values = {"kind": edge.kind, "factor": edge.factor, "via": edge.via}
        out.add_edge(edge.source, edge.target, key, **values)
        if edge.kind in symmetric:
            out.add_edge(edge.target, edge.source, key, **values)
    for kind in KINDS:
        for node in graph.section(kind.section).values():
            for other in kind.neighbours(node):
                ends = node_key(kind.name, node.id), node_key(kind.name, other)
                out.add_edge(*ends, "free", kind="free", factor=None, via=None)
    return out
