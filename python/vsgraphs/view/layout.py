"""How the viewer's window is divided, and from where it looks: Rerun calls it the blueprint."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from vsgraphs.scene_graph import SceneGraph, transform_points
from vsgraphs.trajectory import Array
from vsgraphs.view.extra import blueprint
from vsgraphs.view.layers import bounds, layered_graph, wall_heading

_MAP = (
    "+ /world/**",
    "- /world/camera/depth/**",
    "- /world/camera/image/**",
    "+ /world/camera/image",
    "- /world/planes/ceiling/**",
    "- /world/planes/undecided/**",
    "- /world/planes/other/**",
)


@dataclass(frozen=True)
class Gaze:
    """What to look at: a box with z up, its sides turned by heading_rad against x.

    The eye is `distance` times its diagonal away.
    """

    middle: Array
    size: Array
    heading_rad: float = 0.0
    distance: float = 0.78


AT_START = Gaze(np.array([1.5, 0.0, 1.5]), np.array([7.0, 6.0, 4.0]))


def gaze_at(graph: SceneGraph, up_from_graph: Array) -> Gaze:
    """The whole map with the graph above it, the longer side of the walls across the window."""
    heading = wall_heading(graph, up_from_graph)
    turn = np.eye(4)
    c, s = np.cos(heading), np.sin(heading)
    turn[:2, :2] = [[c, s], [-s, c]]
    low, high = bounds(graph, turn @ up_from_graph)
    tops = [
        layer.places[:, 2].max(initial=high[2])
        for layer in layered_graph(graph, up_from_graph).layers.values()
    ]
    high[2] = max(tops)
    size = high - low
    if size[1] > size[0]:
        heading, size = heading + np.pi / 2, size[[1, 0, 2]]
    middle = transform_points(turn.T, (0.5 * (low + high))[None])[0]
    return Gaze(middle, size, heading)


def layout(gaze: Gaze = AT_START, *, images: bool = True) -> Any:
    """A large view of the map; image and depth at its side."""
    b = blueprint()
    c, s = np.cos(gaze.heading_rad), np.sin(gaze.heading_rad)
    toward = np.array([-0.30, -0.78, 0.55])
    toward = np.array([c * toward[0] - s * toward[1], s * toward[0] + c * toward[1], toward[2]])
    position = gaze.middle + gaze.distance * float(np.linalg.norm(gaze.size)) * toward / np.linalg.norm(
        toward
    )
    view = b.Spatial3DView(
        origin="/world",
        contents=list(_MAP),
        name="Map",
        background=b.Background(kind=b.BackgroundKind.SolidColor, color=(22, 24, 30)),
        line_grid=b.LineGrid3D(visible=False),
        eye_controls=b.EyeControls3D(
            kind=b.Eye3DKind.Orbital,
            position=position,
            look_target=gaze.middle,
            eye_up=(0.0, 0.0, 1.0),
        ),
    )
    if not images:
        return b.Blueprint(view, b.TimePanel(state="hidden"), collapse_panels=True)
    side = b.Vertical(
        b.Spatial2DView(
            origin="/world/camera/image",
            contents=["+ /world/camera/image/**"],
            name="Image, landmarks and classes",
        ),
        b.Spatial2DView(origin="/world/camera/depth", name="Depth"),
    )
    return b.Blueprint(b.Horizontal(view, side, column_shares=[3, 1]), collapse_panels=True)
