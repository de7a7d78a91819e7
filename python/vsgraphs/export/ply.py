"""Coloured points as PLY, binary little-endian."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from vsgraphs.errors import InputError
from vsgraphs.reading import LARGE, read_bytes

_POINT = np.dtype([("position", "<f4", 3), ("colour", "u1", 3)])


def format_ply(positions: npt.NDArray[np.float64], colours: npt.NDArray[np.uint8]) -> bytes:
    """PLY bytes of (M, 3) points in metres and their (M, 3) RGB colours. Positions are stored as float32."""
    vertices = np.empty(len(positions), dtype=_POINT)
    vertices["position"] = positions
    vertices["colour"] = colours
    return _header(len(vertices)) + vertices.tobytes()


def read_ply(path: Path) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.uint8]]:
    """(M, 3) points in metres and (M, 3) colours of a file that `format_ply` made. Raises InputError."""
    data = read_bytes(path, "map", LARGE)
    head, _, body = data.partition(b"end_header\n")
    counts = [line.split()[-1] for line in head.splitlines() if line.startswith(b"element vertex ")]
    count = int(counts[0]) if counts and counts[0].isdigit() and len(counts[0]) < 13 else 0
    if head + b"end_header\n" != _header(count):
        raise InputError(f"{path}: not a point cloud as vsgraphs writes it (map.ply)")
    if len(body) != count * _POINT.itemsize:
        raise InputError(
            f"{path}: {len(body) // _POINT.itemsize} of {count} points are there; copied completely?"
        )
    points = np.frombuffer(body, dtype=_POINT)
    return points["position"].astype(np.float64), points["colour"].copy()


def _header(count: int) -> bytes:
    return (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {count}\n"
        "property float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
    ).encode("ascii")
