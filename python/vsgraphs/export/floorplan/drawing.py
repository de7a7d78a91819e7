"""floorplan.svg: a scene graph seen from above."""

from __future__ import annotations

from typing import Any

import numpy as np

from vsgraphs.export.floorplan.furnishing import draw_frame, draw_legend, draw_title
from vsgraphs.export.floorplan.panel import Panel
from vsgraphs.export.floorplan.storeys import Storey, storeys_of
from vsgraphs.export.floorplan.style import (
    SOFT_INK,
)
from vsgraphs.export.floorplan.svg import Page, number
from vsgraphs.export.floorplan.view import PlanView, view_of
from vsgraphs.scene_graph import SceneGraph
from vsgraphs.trajectory import Array

_MARGIN_PX, _HEAD_PX, _FOOT_PX, _PANEL_GAP_PX = 36.0, 74.0, 84.0, 40.0
_CAPTION_PX = 26.0
_LARGEST_PX = (1500.0, 950.0)
_BORDER_M = 0.45
_FINEST_PX_PER_M = 90.0


def format_floorplan(graph: SceneGraph, positions: Array | None = None, title: str = "Floor plan") -> str:
    """SVG text; equal input gives equal bytes. Works with walls only.

    positions: (N, 3) camera centres in the graph's frame, in order of time (see SceneGraph.poses_from_map).
    """
    walked = np.zeros((0, 3)) if positions is None else np.asarray(positions, dtype=np.float64)
    view = view_of(graph)
    storeys = storeys_of(graph, view, walked)
    low, size_m = _box(storeys, view)
    gaps_px = _PANEL_GAP_PX * (len(storeys) - 1)
    scale = min(
        _FINEST_PX_PER_M,
        (_LARGEST_PX[0] - gaps_px) / (len(storeys) * size_m[0]),
        _LARGEST_PX[1] / size_m[1],
    )
    panel_px = float(size_m[0]) * scale
    plan_px = panel_px * len(storeys) + gaps_px
    head_px = _HEAD_PX + (_CAPTION_PX if len(storeys) > 1 else 0.0)
    width = max(plan_px, 640.0) + 2 * _MARGIN_PX
    height = float(size_m[1]) * scale + head_px + _FOOT_PX
    page = Page()
    draw_frame(page, width, height)
    draw_title(page, graph, title, _MARGIN_PX)
    left = (width - plan_px) / 2
    bottom = height - _FOOT_PX
    for index, storey in enumerate(storeys):
        Panel(page, view, low, np.array([left, bottom]), scale).draw(storey)
        if len(storeys) > 1:
            text = f"floor {index + 1}, {number(round(storey.floor_m, 1))} m"
            style: dict[str, Any] = {"font_size": 13, "fill": SOFT_INK, "text_anchor": "middle"}
            page.text(left + panel_px / 2, head_px - 8, text, **style)
        left += panel_px + _PANEL_GAP_PX
    draw_legend(page, storeys, view, scale, (_MARGIN_PX, height - _FOOT_PX + 40, width - _MARGIN_PX))
    return page.document(width, height, title)


def _box(storeys: list[Storey], view: PlanView) -> tuple[Array, Array]:
    """Lower left corner and size of what is drawn, with a border, metres; one for all storeys, so that what
    lies above one another on the ground does on the page.
    """
    parts = [np.zeros((0, 2))]
    for storey in storeys:
        parts += [strip.corners() for strip in storey.strips] + storey.path
        parts += [view.flat(room.polygon) for room in storey.rooms if len(room.polygon)]
        parts += [view.flat(plane.extent.polygon) for plane in storey.grounds]
        parts += [view.flat(box.corners()) for _, box in storey.boxes]
    points = np.concatenate(parts)
    if not len(points):
        points = np.zeros((1, 2))
    low, high = points.min(axis=0) - _BORDER_M, points.max(axis=0) + _BORDER_M
    return low, np.maximum(high - low, 2.0)
