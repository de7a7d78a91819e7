"""From the map's raw values to nodes in a levelled frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vsgraphs.scene_graph import levelling
from vsgraphs.scene_graph.all_edges import edges_of
from vsgraphs.scene_graph.consistency import check_edges, check_references
from vsgraphs.scene_graph.kinds import KINDS, Kind, Mover
from vsgraphs.scene_graph.kinds.mover import Row, vector

if TYPE_CHECKING:
    from vsgraphs.scene_graph.graph import SceneGraph


def fill_from_map(graph: SceneGraph, raw: Row, keyframes: tuple[Any, Any, Any]) -> None:
    """Fills an empty graph; see SceneGraph.from_map."""
    ids, stamps, poses = keyframes
    poses = np.asarray(poses, dtype=np.float64).reshape(-1, 4, 4)
    up = raw.get("up")
    first = poses[np.argmin(np.asarray(ids))] if len(poses) else np.eye(4)
    graph.frame = levelling.level(None if up is None else vector(up, "up"), raw.get("planes") or [], first)
    mover = Mover(graph.frame, frozenset(map(int, ids)))
    raw = {
        **raw,
        "keyframes": [
            {"id": number, "timestamp_s": stamp, "world_from_camera": pose}
            for number, stamp, pose in zip(ids, stamps, poses, strict=True)
        ],
    }
    graph.estimated = frozenset(kind.section for kind in KINDS if kind.rows(raw) is not None)
    for kind in KINDS:
        graph.set_section(kind.section, _nodes(kind, raw, mover))
    check_references(graph, "the map")
    graph.edges = edges_of(graph, raw.get("wall_pairs") or [])
    check_edges(graph, "the map")


def _nodes(kind: Kind[Any], raw: Row, mover: Mover) -> dict[int, Any]:
    rows = [{**row, "id": int(row["id"])} for row in kind.rows(raw) or []]
    nodes = (kind.from_map(row, mover) for row in sorted(rows, key=lambda row: int(row["id"])))
    return {node.id: node for node in nodes if node is not None}
