"""The attributes of spark-dsg's nodes, layer by layer, from what each kind of node says of itself."""

from __future__ import annotations

from typing import Any

import numpy as np

from vsgraphs.export.spark_attributes import (
    UPRIGHT,
    Json,
    box_row,
    common_attributes,
    object_attributes,
    rotation_row,
    rounded,
    semantic_attributes,
)
from vsgraphs.scene_graph import KINDS, Kind, SceneGraph

ROBOT = "a"
LAYERS = {"agents": 2, "objects": 2, "places": 3, "rooms": 4, "buildings": 5}  # agents: in a partition of 2
_NO_LABEL = 4294967295


def labels_of(layer: str) -> list[str]:
    """The label space of a layer: what its kinds' nodes may be called, each once."""
    return list(
        dict.fromkeys(label for kind in KINDS if kind.spark.layer == layer for label in kind.spark.labels)
    )


def attributes_of(kind: Kind[Any], node: Any, graph: SceneGraph) -> Json:
    """A node's attributes, as its layer has them."""
    return _BY_LAYER[kind.spark.layer](kind, node, graph)


def _agent(kind: Kind[Any], node: Any, _: SceneGraph) -> Json:
    rotation = kind.rotation(node)
    return {
        **common_attributes("AgentNodeAttributes", kind.place(node)),
        "timestamp": round(kind.details(node)["timestamp_s"] * 1e9),
        "world_R_body": UPRIGHT if rotation is None else rotation_row(rotation),
        "external_key": node.id,
        "dbow_ids": None,
        "dbow_values": None,
    }


def _object(kind: Kind[Any], node: Any, graph: SceneGraph) -> Json:
    title, label, colour = kind.title(node, graph), _label(kind, node), kind.rgb(node)
    attributes = object_attributes(title, kind.place(node), label, colour, _details(kind, node))
    rotation, box = kind.rotation(node), kind.box(node, graph)
    if rotation is not None:
        attributes["world_R_object"] = rotation_row(rotation)
    if box is not None:
        attributes["bounding_box"] = box_row(box.centre, box.size, box.rotation)
    return attributes


def _place(kind: Kind[Any], node: Any, graph: SceneGraph) -> Json:
    title, label = kind.title(node, graph), _label(kind, node)
    return {
        **semantic_attributes("PlaceNodeAttributes", title, kind.place(node), label, kind.rgb(node)),
        "active_frontier": False,
        "anti_frontier": False,
        "deformation_connections": [],
        "frontier_scale": [0.0, 0.0, 0.0],
        "mesh_vertex_labels": [],
        "need_cleanup": False,
        "num_basis_points": 0,
        "num_frontier_voxels": 0,
        "orientation": UPRIGHT,
        "pcl_mesh_connections": [],
        "real_place": True,
        "voxblox_mesh_connections": [],
        "distance": rounded(kind.details(node)["clearance_m"]),
    }


def _room(kind: Kind[Any], node: Any, graph: SceneGraph) -> Json:
    title, label = kind.title(node, graph), _label(kind, node)
    attributes = semantic_attributes("RoomNodeAttributes", title, kind.place(node), label, kind.rgb(node))
    attributes["metadata"] = _details(kind, node)
    box = kind.box(node, graph)
    if box is not None:
        attributes["bounding_box"] = box_row(box.centre, box.size, box.rotation)
    return {**attributes, "semantic_class_probabilities": {}}


_BY_LAYER = {"agents": _agent, "objects": _object, "places": _place, "rooms": _room, "buildings": _room}


def _label(kind: Kind[Any], node: Any) -> int:
    label = kind.label(node)
    return _NO_LABEL if label is None else labels_of(kind.spark.layer).index(label)


def _details(kind: Kind[Any], node: Any) -> Json:
    return {
        name: rounded(value) if isinstance(value, np.ndarray | float) else value
        for name, value in kind.details(node).items()
    }
