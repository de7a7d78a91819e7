"""One colour for each class of plane, the same in every picture and point cloud."""

from __future__ import annotations

CLASS_COLOURS: dict[str, tuple[int, int, int]] = {
    "wall": (70, 118, 181),
    "ground": (120, 160, 82),
    "ceiling": (190, 160, 214),
    "door": (214, 137, 58),
    "window": (98, 196, 214),
    "other": (170, 120, 110),
    "undecided": (200, 200, 200),
}
NO_PLANE = (120, 120, 120)  # a point that lies on no plane
