"""The frame that a scene graph's coordinates are in."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from vsgraphs.trajectory import Array


@dataclass(eq=False)
class Frame:
    """Which frame the graph's coordinates are in.

    levelled: z is up, x the first camera's horizontal viewing direction (REP-103), the origin plumb under the
    first camera. Otherwise it is the map's: the first keyframe's camera, x right, y down, z forward.
    world_from_map: (4, 4), map coordinates to the graph's. ground: the plane that z = 0 stands on at the
    origin; None: no ground was seen and z = 0 is the first camera's height (or nothing is levelled).
    """

    levelled: bool = False
    world_from_map: Array = field(default_factory=lambda: np.eye(4))
    ground: int | None = None

    @property
    def up(self) -> Array | None:
        """(3,) unit vector against gravity; None while unknown."""
        return np.array([0.0, 0.0, 1.0]) if self.levelled else None

    @property
    def zero_height(self) -> str:
        """What z = 0 is, for people."""
        if not self.levelled:
            return "the first camera (not levelled)"
        return "the first camera's height" if self.ground is None else f"ground plane {self.ground}"
