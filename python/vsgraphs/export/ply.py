"""Coloured points as PLY, binary little-endian."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def format_ply(positions: npt.NDArray[np.float64], colours: npt.NDArray[np.uint8]) -> bytes:
    """PLY bytes of (M, 3) points in metres and their (M, 3) RGB colours. Positions are stored as float32."""
    vertices = np.empty(len(positions), dtype=[("position", "<f4", 3), ("colour", "u1", 3)])
    vertices["position"] = positions
    vertices["colour"] = colours
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(vertices)}\n"
        "property float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
    )
    return header.encode("ascii") + vertices.tobytes()
