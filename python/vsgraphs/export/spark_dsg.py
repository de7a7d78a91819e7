"""scene_graph.dsg.json: the JSON that the package spark-dsg loads.

Hughes, Chang and Carlone, "Hydra: a real-time spatial perception system for 3D scene graph construction and
optimization", RSS 2022. Written from the format the package itself saves (header version 1.1.3); the package
is not needed to write it.

Each kind of node says which layer it is in, which letter its ids have and what its nodes may be called in the
layer's label space; keyframes are agents of robot "a". What spark-dsg has no field for is in each node's
`metadata`.
"""

from __future__ import annotations

import json
from itertools import pairwise
from typing import Any

from vsgraphs.export.spark_attributes import Json, edge_row, layer_key, node_row, rounded, symbol, text_line
from vsgraphs.export.spark_nodes import LAYERS, ROBOT, attributes_of, labels_of
from vsgraphs.scene_graph import KINDS, Frame, Kind, SceneGraph

_FORMAT_VERSION = {"major": 1, "minor": 1, "patch": 3}


def format_spark_dsg(graph: SceneGraph) -> str:
    """The text of scene_graph.dsg.json, a node or edge per line."""
    layers = {name.upper(): layer_key(number) for name, number in LAYERS.items() if name != "agents"}
    agents = layer_key(LAYERS["agents"], ord(ROBOT))
    head = {
        "SPARK_DSG_header": {"project_name": "main", "version": _FORMAT_VERSION},
        "directed": False,
        "multigraph": False,
        "layer_keys": [layers["OBJECTS"], agents, *(layers[n] for n in ("PLACES", "ROOMS", "BUILDINGS"))],
        "layer_names": {"AGENTS": layer_key(LAYERS["agents"]), **layers},
        "metadata": _metadata(graph.frame),
    }
    parts = [f"{json.dumps(name)}: {text_line(value)}" for name, value in head.items()]
    parts.append('"nodes": [\n' + ",\n".join(map(text_line, _nodes(graph))) + "\n]")
    parts.append('"edges": [\n' + ",\n".join(map(text_line, _edges(graph))) + "\n]")
    return "{\n" + ",\n".join(parts) + "\n}\n"


def _metadata(frame: Frame) -> Json:
    spaces = {layer: labels_of(layer) for layer in ("objects", "rooms")}
    return {
        "labelspaces": {
            f"_l{LAYERS[layer]}p0": [[i, name] for i, name in enumerate(labels)]
            for layer, labels in spaces.items()
        },
        "vsgraphs": {"levelled": frame.levelled, "world_from_map": rounded(frame.world_from_map)},
    }


def _nodes(graph: SceneGraph) -> list[Json]:
    rows = []
    for layer, number in LAYERS.items():
        partition = ord(ROBOT) if layer == "agents" else 0
        for kind in (kind for kind in KINDS if kind.spark.layer == layer):
            for node in graph.section(kind.section).values():
                attributes = attributes_of(kind, node, graph)
                rows.append(node_row(kind.spark.symbol, node.id, number, attributes, partition))
    return rows


def _edges(graph: SceneGraph) -> list[Json]:
    """Ways, what is in what, and what joins two nodes of a kind: it is named in the edge."""
    edges: list[Json] = []
    joined: dict[tuple[int, int], dict[str, list[int]]] = {}
    symbols = {kind.name: kind.spark.symbol for kind in KINDS}
    for kind in KINDS:
        nodes = graph.section(kind.section)
        letter = kind.spark.symbol
        if kind.spark.layer == "agents":
            edges += [edge_row(symbol(letter, a), symbol(letter, b)) for a, b in pairwise(nodes)]
        for node in nodes.values():
            onward = (other for other in kind.neighbours(node) if other > node.id)
            edges += [edge_row(symbol(letter, node.id), symbol(letter, other)) for other in onward]
            ends = kind.joins(node)
            if ends is not None:
                a, b = sorted(symbol(symbols[ends[0]], number) for number in ends[1:])
                joined.setdefault((a, b), {}).setdefault(kind.section, []).append(node.id)
    edges += [edge_row(parent, child) for child, parent in sorted(_parents(graph).items())]
    return edges + [edge_row(a, b, through) for (a, b), through in sorted(joined.items())]


def _parents(graph: SceneGraph) -> dict[int, int]:
    """Child -> its one parent, as spark-dsg has it: a wall that bounds two rooms is under the first."""
    symbols = {kind.name: kind.spark.symbol for kind in KINDS}
    parents: dict[int, int] = {}
    for kind, node, key in _keyed(graph):
        for name, number in kind.children(node):
            parents.setdefault(symbol(symbols[name], number), key)
        above = kind.parent(node)
        if above is not None:
            parents[key] = symbol(symbols[above[0]], above[1])
    return parents


def _keyed(graph: SceneGraph) -> list[tuple[Kind[Any], Any, int]]:
    """Every node with its kind and its id in spark-dsg."""
    return [
        (kind, node, symbol(kind.spark.symbol, node.id))
        for kind in KINDS
        for node in graph.section(kind.section).values()
    ]
