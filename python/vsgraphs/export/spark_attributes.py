"""The pieces of spark-dsg's JSON: nodes, edges and their attributes, as its version 1.1.3 saves them."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from vsgraphs.trajectory import Array, quaternions_from_rotations

Json = dict[str, Any]

UPRIGHT = {"w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0}
_NO_FEATURE = {"cols": 0, "data": None, "rows": 0}


def symbol(prefix: str, number: int) -> int:
    """A node's id: the letter in the highest byte."""
    return (ord(prefix) << 56) | number


def layer_key(layer: int, partition: int = 0) -> Json:
    """Which layer a node is in."""
    return {"layer": layer, "partition": partition}


def node_row(prefix: str, number: int, layer: int, attributes: Json, partition: int = 0) -> Json:
    """A node."""
    return {"id": symbol(prefix, number), **layer_key(layer, partition), "attributes": attributes}


def edge_row(source: int, target: int, metadata: Json | None = None) -> Json:
    """An edge between two ids; between layers the parent is the source."""
    info = {"type": "EdgeAttributes", "weight": 1.0, "weighted": False, "metadata": metadata or {}}
    return {"source": source, "target": target, "info": info}


def common_attributes(kind: str, position: Array) -> Json:
    """What every node has. kind: the class's name in spark-dsg; position: (3,)."""
    return {
        "type": kind,
        "position": rounded(position),
        "last_update_time_ns": 0,
        "is_active": False,
        "is_predicted": False,
        "metadata": {},
    }


def semantic_attributes(kind: str, name: str, position: Array, label: int, rgb: tuple[int, int, int]) -> Json:
    """What every named node has; its box is invalid until one is set."""
    return {
        **common_attributes(kind, position),
        "name": name,
        "color": {**dict(zip("rgb", rgb, strict=True)), "a": 255},
        "bounding_box": {**box_row(np.zeros(3), np.zeros(3)), "type": "INVALID"},
        "semantic_label": label,
        "semantic_feature": _NO_FEATURE,
    }


def object_attributes(
    name: str, position: Array, label: int, rgb: tuple[int, int, int], details: Json
) -> Json:
    """An object; `details` is its metadata."""
    attributes = semantic_attributes("ObjectNodeAttributes", name, position, label, rgb)
    shape = {"mesh_connections": [], "registered": True, "world_R_object": UPRIGHT}
    return {**attributes, **shape, "metadata": details}


def box_row(centre: Array, size: Array, rotation: Array | None = None) -> Json:
    """A bounding box along the frame's axes, or along the columns of (3, 3) `rotation`."""
    return {
        "type": "AABB" if rotation is None else "OBB",
        "dimensions": rounded(size),
        "world_P_center": rounded(centre),
        "world_R_center": UPRIGHT if rotation is None else rotation_row(rotation),
    }


def rotation_row(rotation: Array) -> Json:
    """(3, 3) as a quaternion."""
    return dict(zip("xyzw", rounded(quaternions_from_rotations(rotation[None])[0]), strict=True))


def rounded(value: Array | float) -> Any:
    """Plain numbers, to 1e-9, without minus zero."""
    return (np.round(np.asarray(value, dtype=np.float64), 9) + 0.0).tolist()


def text_line(value: Any) -> str:
    """JSON on one line."""
    return json.dumps(value, ensure_ascii=False, separators=(", ", ": "), allow_nan=False)
