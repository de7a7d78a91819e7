"""From the graph's frame to a plan seen from above."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vsgraphs.scene_graph import PlaneNode, SceneGraph
from vsgraphs.trajectory import Array


@dataclass(eq=False)
class PlanView:
    """axes: (2, 3) the page's right and its top, in the graph's frame; up: (3,) toward the reader."""

    axes: Array
    up: Array

    def flat(self, points: Array) -> Array:
        """(N, 3) -> (N, 2), metres, right and up on the page."""
        flat: Array = points @ self.axes.T
        return flat

    def height(self, points: Array) -> Array:
        """(N, 3) -> (N,) metres along up."""
        height: Array = points @ self.up
        return height

    def direction(self, vector: Array) -> Array:
        """(3,) -> (2,) unit vector."""
        flat = self.axes @ vector
        unit: Array = flat / max(float(np.linalg.norm(flat)), 1e-12)
        return unit


def view_of(graph: SceneGraph) -> PlanView:
    """From above, turned so that most wall runs straight across the page and the plan is wider than high.

    Of a graph that is not levelled: the map's x and z; how level that is depends on how the first camera was
    held.
    """
    levelled = graph.frame.levelled
    base = np.array([[1.0, 0, 0], [0, 1, 0]]) if levelled else np.array([[1.0, 0, 0], [0, 0, 1]])
    up = np.array([0.0, 0, 1]) if levelled else np.array([0.0, -1, 0])
    view = PlanView(base, up)
    walls = [plane for plane in graph.planes_of("wall") if len(plane.extent.runs)]
    if walls:
        view = PlanView(_turn(-_main_direction(walls, view)) @ base, up)
        width, height = np.ptp(view.flat(np.concatenate([wall.extent.polygon for wall in walls])), axis=0)
        if height > width:
            view = PlanView(_turn(np.pi / 2) @ view.axes, up)
    return view


def _main_direction(walls: list[PlaneNode], view: PlanView) -> float:
    """Angle of most wall, by area, where right angles are alike: within 45 degrees of zero."""
    total = 0j
    for wall in walls:
        u, v = view.direction(wall.extent.axis_u)
        total += wall.area_m2 * np.exp(4j * np.arctan2(v, u))
    return float(np.angle(total)) / 4 if abs(total) > 1e-9 else 0.0


def _turn(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])
