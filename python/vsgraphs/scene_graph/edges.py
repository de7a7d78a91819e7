"""Typed relations between nodes, each with the factor of the optimisation that stands behind it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Edge:
    """source and target: "kind:id", as "plane:3". Symmetric kinds are kept once, the smaller id first.

    factor: its name in the optimisation; None where nothing is optimised. via: the door of a door edge.
    """

    kind: str
    source: str
    target: str
    factor: str | None
    via: str | None = None


@dataclass(frozen=True)
class Relation:
    """A kind of edge. source: the kind of node at its source. factor: None where no factor holds it.

    via: the kind of node it leads through; None: through none.
    """

    kind: str
    source: str
    factor: str | None = None
    symmetric: bool = False
    via: str | None = None

    def edge(self, source: int, target: str, via: str | None = None) -> Edge:
        """From a node of the kind `source` to a node given by its key."""
        return Edge(self.kind, node_key(self.source, source), target, self.factor, via)

    def between(self, a: int, b: int, via: str | None = None) -> Edge:
        """Between two nodes of one kind, the smaller id first."""
        return self.edge(min(a, b), node_key(self.source, max(a, b)), via)


def node_key(kind: str, number: int) -> str:
    """How edges and networkx name a node."""
    return f"{kind}:{number}"
