"""From the map's raw values to plain ones in the graph's frame."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from vsgraphs.errors import InputError
from vsgraphs.scene_graph import levelling
from vsgraphs.scene_graph.frame import Frame
from vsgraphs.trajectory import Array

Row = Mapping[str, Any]


class Mover:
    """Takes the map's geometry into the graph's frame.

    transform: (4, 4) world_from_map. keyframes: the ids of those that are in the map.
    """

    def __init__(self, frame: Frame, keyframes: frozenset[int] = frozenset()) -> None:
        self.frame, self.transform, self.keyframes = frame, frame.world_from_map, keyframes

    def points(self, values: Any, what: str) -> Array:
        """(N, 3) points. Raises InputError, which names `what`, where one is not finite."""
        points = np.asarray(values, dtype=np.float64).reshape(-1, 3)
        return finite(levelling.transform_points(self.transform, points), what)

    def point(self, values: Any, what: str) -> Array:
        """(3,) a point; as above."""
        point: Array = self.points(vector(values, what), what)[0]
        return point

    def direction(self, values: Any, what: str) -> Array:
        """(3,) a direction; as above."""
        direction: Array = self.transform[:3, :3] @ vector(values, what)
        return direction

    def pose(self, values: Any, what: str) -> Array:
        """(4, 4) a pose map_from_x; as above."""
        pose = np.asarray(values, dtype=np.float64).reshape(4, 4)
        return finite(self.transform @ pose, what)

    def observers(self, row: Row) -> list[int]:
        """The keyframes that saw it; others were culled."""
        return id_list(set(map(int, row.get("observed_by", ()))) & self.keyframes)


def id_or_none(value: Any) -> int | None:
    """An id, or none."""
    return None if value is None else int(value)


def id_list(values: Iterable[Any]) -> list[int]:
    """In ascending order."""
    return sorted(int(value) for value in values)


def number_or_none(value: Any) -> float | None:
    """None and NaN, the core's word for unknown, are None."""
    return None if value is None or not np.isfinite(value) else float(value)


def vector(values: Any, what: str) -> Array:
    """(3,) finite. Raises InputError, which names `what`."""
    return finite(np.asarray(values, dtype=np.float64).reshape(3), what)


def finite(values: Array, what: str) -> Array:
    """The values. Raises InputError, which names `what`, where one is not finite."""
    if not np.isfinite(values).all():
        raise InputError(f"{what}: not finite")
    return values
