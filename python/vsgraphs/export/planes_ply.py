"""The planes of a scene graph as a coloured mesh: planes.ply, for MeshLab, CloudCompare, Open3D."""

from __future__ import annotations

import numpy as np

from vsgraphs.scene_graph import CLASS_COLOURS, PlaneExtent, SceneGraph
from vsgraphs.trajectory import Array

_FACE = np.dtype([("count", "u1"), ("corners", "<i4", 4)])


def format_planes_ply(graph: SceneGraph) -> bytes:
    """PLY bytes: every observed cell of every plane, coloured by class, neighbours in a row as one.

    Doorways and other unseen parts stay open. Each vertex carries `plane` (the id) and the normal.
    """
    vertices, faces = [], []
    start = 0
    for plane in graph.planes.values():
        corners = run_corners(plane.extent)
        block = np.empty(
            len(corners) * 4,
            dtype=[("xyz", "<f4", 3), ("normal", "<f4", 3), ("rgb", "u1", 3), ("plane", "<i4")],
        )
        block["xyz"] = corners.reshape(-1, 3)
        block["normal"], block["plane"] = plane.normal, plane.id
        block["rgb"] = CLASS_COLOURS[plane.role]
        quads = np.empty(len(corners), dtype=_FACE)
        quads["count"] = 4
        quads["corners"] = start + np.arange(len(block)).reshape(-1, 4)
        vertices.append(block.tobytes())
        faces.append(quads.tobytes())
        start += len(block)
    floats = "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
    colours = "".join(f"property uchar {name}\n" for name in ("red", "green", "blue"))
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {start}\n{floats}{colours}property int plane\n"
        f"element face {start // 4}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    return header.encode("ascii") + b"".join(vertices) + b"".join(faces)


def run_corners(extent: PlaneExtent) -> Array:
    """(R, 4, 3) corners of the rectangle that each run of cells covers, counter-clockwise from the front."""
    v, first, last = extent.runs.T if len(extent.runs) else np.zeros((3, 0), np.int64)
    u0, u1, v0, v1 = first, last + 1, v, v + 1
    uv = np.stack([np.stack(pair, axis=1) for pair in ((u0, v0), (u1, v0), (u1, v1), (u0, v1))], axis=1)
    corners: Array = extent.lift(uv.reshape(-1, 2) * extent.cell_m).reshape(-1, 4, 3)
    return corners
