"""Grey PNG files, written fast and without holding up other threads.

PNG (Portable Network Graphics) Specification, second edition, ISO/IEC 15948:2003.
"""

from __future__ import annotations

import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_LEVEL = 1  # of compression: three times as fast as the usual one, and a few per cent larger


def write_grey_png(pixels: npt.NDArray[Any], path: Path) -> None:
    """pixels: (h, w) uint8 or uint16."""
    height, width = pixels.shape
    depth = 8 * pixels.dtype.itemsize
    rows = np.zeros(
        (height, 1 + width * pixels.dtype.itemsize), np.uint8
    )  # each begins with its filter: 0, none
    rows[:, 1:] = pixels.astype(pixels.dtype.newbyteorder(">")).view(np.uint8).reshape(height, -1)
    header = struct.pack(">IIBBBBB", width, height, depth, 0, 0, 0, 0)
    data = zlib.compress(rows.data, _LEVEL)  # lets other threads work meanwhile
    path.write_bytes(_SIGNATURE + _chunk(b"IHDR", header) + _chunk(b"IDAT", data) + _chunk(b"IEND", b""))


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(data, zlib.crc32(name)))
