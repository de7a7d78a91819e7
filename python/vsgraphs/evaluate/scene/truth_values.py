"""Lengths and places in scene_gt.json."""

from __future__ import annotations

from typing import Any

import numpy as np

from vsgraphs.trajectory import Array

_LARGEST_M = 1e5  # of a building


def point_of(value: Any) -> Array:
    """(3,) a point. Raises ValueError."""
    return _measured(np.array(value, dtype=np.float64).reshape(3))


def outline_of(value: Any) -> Array:
    """(N, 2) corners, at least 3. Raises ValueError."""
    corners = np.array(value, dtype=np.float64)
    if corners.ndim != 2 or len(corners) < 3 or corners.shape[1] < 2:
        raise ValueError(f"a polygon of shape {corners.shape}, expected at least 3 corners")
    return _measured(corners[:, :2])


def number_of(value: Any) -> float:
    """A length. Raises ValueError."""
    return float(_measured(np.array(value, dtype=np.float64)))


def _measured(lengths: Array) -> Array:
    if not (np.abs(lengths) <= _LARGEST_M).all():  # false for NaN, too
        raise ValueError(f"a length beyond {_LARGEST_M:g} m")
    return lengths
