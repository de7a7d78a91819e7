"""Areas of arbitrary simple polygons, and what two of them share, by rasterising.

Cells of 2 cm, counted where their middle is inside: an area is off by at most about 1 cm times the outline's
length, 1 % for a room of 4 by 3 m. No polygon is too odd for it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vsgraphs.errors import InputError
from vsgraphs.scene_graph import inside_polygon
from vsgraphs.trajectory import Array

CELL_M = 0.02
_LARGEST_M2 = 40_000.0  # 100 million cells


@dataclass(eq=False)
class Raster:
    """A polygon's cells: mask[i, j] is cell (least + (i, j)) of a grid through the frame's origin."""

    least: npt.NDArray[np.int64]
    mask: npt.NDArray[np.bool_]

    @property
    def cells(self) -> int:
        """How many are inside."""
        return int(np.count_nonzero(self.mask))


def rasterise(polygon: Array) -> Raster:
    """(N, 2) corners of a simple polygon, either way round, metres. Cost: cells of its box times N.

    Raises InputError for an outline larger than any building.
    """
    size = polygon.max(axis=0) - polygon.min(axis=0)
    if not size[0] * size[1] <= _LARGEST_M2:
        raise InputError(f"a room's outline of {size[0]:g} x {size[1]:g} m is larger than any building")
    least = np.floor(polygon.min(axis=0) / CELL_M).astype(np.int64)
    most = np.ceil(polygon.max(axis=0) / CELL_M).astype(np.int64)
    i, j = np.meshgrid(np.arange(least[0], most[0]), np.arange(least[1], most[1]), indexing="ij")
    points = (np.stack([i.ravel(), j.ravel()], axis=1) + 0.5) * CELL_M
    return Raster(least, inside_polygon(points, polygon).reshape(i.shape))


def common_cells(a: Raster, b: Raster) -> int:
    """Cells inside both."""
    low = np.maximum(a.least, b.least)
    high = np.minimum(a.least + a.mask.shape, b.least + b.mask.shape)
    if (high <= low).any():
        return 0
    windows = []
    for raster in (a, b):
        (i0, j0), (i1, j1) = low - raster.least, high - raster.least
        windows.append(raster.mask[i0:i1, j0:j1])
    return int(np.count_nonzero(windows[0] & windows[1]))


def intersection_over_union(a: Raster, b: Raster) -> float:
    """0 to 1; 0 where both are empty."""
    common = common_cells(a, b)
    union = a.cells + b.cells - common
    return common / union if union else 0.0
