"""How near an estimated entity must come to a true one."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields

from vsgraphs.errors import InputError
from vsgraphs.reading import shortened, shown


@dataclass(frozen=True)
class SceneOptions:
    """Tolerances; docs/scene_graph.md says why these.

    angle_deg, offset_m: of a plane against a true one, the offset at the true wall's middle. ate_factor: the
    offset may also reach this many times the trajectory's ATE, at most offset_limit_m: a wall cannot stand
    more exactly than the cameras that saw it. overlap: share of the shorter of both extents that must be
    common. piece_gap_m: a second piece of a found wall is a duplicate unless this far from the first.
    room_iou: least intersection over union of a found room. door_m: between the middles of thresholds.
    storey_m: rooms, doors and floors this far apart in height are on different storeys. near_m: a map point
    farther from every true surface lies on furniture. within_m: what counts as on the surface.
    """

    angle_deg: float = 10.0
    offset_m: float = 0.2
    ate_factor: float = 2.0
    offset_limit_m: float = 0.4
    overlap: float = 0.3
    piece_gap_m: float = 1.5
    room_iou: float = 0.5
    door_m: float = 0.5
    storey_m: float = 1.0
    near_m: float = 0.3
    within_m: float = 0.1

    def offset_tolerance_m(self, ate_m: float | None) -> float:
        """Largest offset of a plane, given the trajectory's ATE (None: unknown)."""
        slack = min(self.ate_factor * (ate_m or 0.0), self.offset_limit_m)
        return max(self.offset_m, slack)


def options_from(assignments: Iterable[str]) -> SceneOptions:
    """KEY=VALUE texts -> options. Raises InputError for unknown keys and for what is no positive number."""
    known = [field.name for field in fields(SceneOptions)]
    values: dict[str, float] = {}
    for text in assignments:
        key, _, value = text.partition("=")
        if key not in known:
            raise InputError(f"unknown tolerance {shown(key)}; known: {', '.join(known)}")
        try:
            values[key] = float(value)
        except ValueError:
            raise InputError(f"tolerance {key}: {shown(value)} is not a number") from None
        if not math.isfinite(values[key]) or values[key] < 0:
            raise InputError(f"tolerance {key}: {shortened(value)} must be finite and not negative")
    return SceneOptions(**values)
