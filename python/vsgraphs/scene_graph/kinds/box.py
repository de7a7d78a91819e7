"""A box in space: how far something reaches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vsgraphs.trajectory import Array

_SIDES = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1]]) / 2
_RISE = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class Box:
    """centre, size: (3,) m. rotation: (3, 3), the box's axes as columns; None: along the frame's."""

    centre: Array
    size: Array
    rotation: Array | None = None

    def corners(self) -> Array:
        """(8, 3): the four below, one after the other around the box, then the four above them."""
        unit = np.concatenate([_SIDES, _SIDES + _RISE]) * self.size
        turned: Array = unit if self.rotation is None else unit @ self.rotation.T
        return turned + self.centre
