"""Where a room's name goes."""

from __future__ import annotations

import numpy as np

from vsgraphs.scene_graph import inside_polygon
from vsgraphs.trajectory import Array

_WIDER = 2.2  # a name is wider than high


def label_place(polygon: Array, avoid: Array) -> tuple[Array, float]:
    """(N, 2) corners -> the place in it farthest from its outline, and that distance, metres.

    avoid: (M, 2) places that a label had rather not cover.
    """
    low, high = polygon.min(axis=0), polygon.max(axis=0)
    grid = np.stack(
        [axis.ravel() for axis in np.meshgrid(*np.linspace(low, high, 41).T, indexing="ij")], axis=1
    )
    grid = grid[inside_polygon(grid, polygon)]
    if not len(grid):
        return polygon.mean(axis=0), 0.0
    room = np.full(len(grid), np.inf)
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        side = b - a
        t = np.clip((grid - a) @ side / max(float(side @ side), 1e-12), 0, 1)
        np.minimum(room, np.linalg.norm(grid - a - t[:, None] * side, axis=1), out=room)
    score = room - 0.05 * np.linalg.norm(grid - polygon.mean(axis=0), axis=1)
    near = avoid[((avoid > low - 1) & (avoid < high + 1)).all(axis=1)]
    if len(near):
        away = (grid[:, None] - near[None]) / (_WIDER, 1.0)
        score = np.minimum(score, 0.1 + np.sqrt((away**2).sum(axis=2).min(axis=1)))
    best = int(np.argmax(np.round(score, 6)))
    return grid[best], float(room[best])


def dense(line: Array, step_m: float = 0.15) -> Array:
    """(N, 2) corners of a line -> places along it, at most step_m apart."""
    if len(line) < 2:
        return line
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    at = np.linspace(0.0, along[-1], int(along[-1] / step_m) + 2)
    return np.stack([np.interp(at, along, column) for column in line.T], axis=1)
