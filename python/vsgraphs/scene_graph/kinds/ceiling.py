"""Ceilings of rooms."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from vsgraphs.scene_graph.colours import CLASS_COLOURS
from vsgraphs.scene_graph.kinds.element import ElementKind
from vsgraphs.scene_graph.kinds.kind import SparkPlace


class CeilingKind(ElementKind):
    """Over the outline of each room where one was seen, and scored against the true rooms' ceilings."""

    name, section = "ceiling", "ceilings"
    colour = CLASS_COLOURS["ceiling"]
    spark = SparkPlace("objects", "C", ("ceiling area",))
    description = "The ceiling of a room, over its outline."
    in_plan = False
    truth = "ceilings"
    within_m = 1.0

    def true_rows(self, document: Mapping[str, Any]) -> list[Mapping[str, Any]] | None:
        """Of rooms with a flat ceiling: its middle."""
        rows: list[Mapping[str, Any]] = []
        for room in document["rooms"]:
            if "slope" in room:
                continue
            middle = np.asarray(room["polygon"], dtype=np.float64).mean(axis=0)
            center = [*middle.tolist(), float(room["z_floor"]) + float(room["height"])]
            rows.append({"id": room["id"], "room": room["id"], "center": center})
        return rows
