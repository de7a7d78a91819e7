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
)


@dataclass(frozen=True)
class Gaze:
    """What to look at: a box with z up, its sides turned by heading_rad against x.

    The eye is `distance` times its diagonal away, above the corner `side`.
    """

    middle: Array
    size: Array
    heading_rad: float = 0.0
    side: tuple[int, int] = (-1, -1)  # on which side of the box the eye is, along and across
    distance: float = 0.87


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
    corners = [(x, y) for x in (-1, 1) for y in (-1, 1)]
    side = max(corners, key=lambda corner: _wall_seen(graph, up_from_graph, _toward(heading, corner)))
    return Gaze(middle, size, heading, side)


def _toward(heading_rad: float, side: tuple[int, int]) -> Array:
    """(3,) unit vector from the box to the eye."""
    c, s = np.cos(heading_rad), np.sin(heading_rad)
    x, y, z = 0.30 * side[0], 0.78 * side[1], 0.55
    toward: Array = np.array([c * x - s * y, s * x + c * y, z]) / np.sqrt(x * x + y * y + z * z)
    return toward


def _wall_seen(graph: SceneGraph, up_from_graph: Array, toward: Array) -> float:
    """How much wall turns its inside to the eye, m²: walls seen from one side only should stand behind."""
    facing = [float(up_from_graph[:3, :3] @ w.normal @ toward) * w.area_m2 for w in graph.planes_of("wall")]
    return round(sum(facing), 1)


def layout(gaze: Gaze = AT_START, *, images: bool = True) -> Any:
    """A large view of the map; image and depth at its side."""
    b = blueprint()
    distance = gaze.distance * float(np.linalg.norm(gaze.size))
    position = gaze.middle + distance * _toward(gaze.heading_rad, gaze.side)
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
