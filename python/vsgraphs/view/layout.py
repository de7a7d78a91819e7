"""How the viewer's window is divided, and from where it looks: Rerun calls it the blueprint."""

from __future__ import annotations

from typing import Any

import numpy as np

from vsgraphs.trajectory import Array
from vsgraphs.view.extra import blueprint

_MAP = (
    "+ /world/**",
    "- /world/camera/depth/**",
    "- /world/camera/image/**",
    "+ /world/camera/image",
    "- /world/planes/ceiling/**",
    "- /world/planes/undecided/**",
    "- /world/planes/other/**",
)


def layout(low: Array | None = None, high: Array | None = None, *, images: bool = True) -> Any:
    """A large view of the map; image and depth at its side. low, high: (3,) corners of the box to look at, z up."""
    b = blueprint()
    low = np.array([-2.0, -3.0, 0.0]) if low is None else low
    high = np.array([5.0, 3.0, 4.0]) if high is None else high
    middle, reach = (low + high) / 2, float(np.linalg.norm(high - low))
    toward = np.array([-0.42, -0.72, 0.50])
    if high[1] - low[1] > high[0] - low[0]:  # across the longer side, which then lies across the window
        toward = np.array([-0.72, 0.42, 0.50])
    view = b.Spatial3DView(
        origin="/world",
        contents=list(_MAP),
        name="Map",
        background=b.Background(kind=b.BackgroundKind.SolidColor, color=(22, 24, 30)),
        line_grid=b.LineGrid3D(visible=False),
        eye_controls=b.EyeControls3D(
            kind=b.Eye3DKind.Orbital,
            position=middle + 0.95 * reach * toward / np.linalg.norm(toward),
            look_target=middle,
            eye_up=(0.0, 0.0, 1.0),
        ),
    )
    if not images:
        return b.Blueprint(view, collapse_panels=True)
    side = b.Vertical(
        b.Spatial2DView(
            origin="/world/camera/image",
            contents=["+ /world/camera/image/**"],
            name="Image, landmarks and classes",
        ),
        b.Spatial2DView(origin="/world/camera/depth", name="Depth"),
    )
    return b.Blueprint(b.Horizontal(view, side, column_shares=[3, 1]), collapse_panels=True)
