"""What a scene graph is made of. Lengths in metres; positions in the graph's frame (`Frame`)."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from vsgraphs.scene_graph.extent import PlaneExtent
from vsgraphs.trajectory import Array

SECTIONS = ("keyframes", "planes", "rooms", "floors", "doors", "markers", "places")
ROLES = ("undecided", "wall", "ground", "ceiling", "door", "window", "other")


@dataclass(eq=False)
class KeyframeNode:
    """A camera pose of the map. world_from_camera: (4, 4), optical axes (x right, y down, z forward)."""

    id: int
    timestamp_s: float
    world_from_camera: Array


@dataclass(eq=False)
class PlaneNode:
    """A building component, or a plane that is none (yet): one face, seen from one side.

    normal . x + offset_m = 0; `normal` (3,) is a unit vector toward the side that saw it (into the room).
    votes: per role, as summed up by the map. centroid: (3,), the middle of the observed extent, on the plane.
    other_face: the plane that is this wall's back, thickness_m away.
    """

    id: int
    role: str
    votes: dict[str, float]
    normal: Array
    offset_m: float
    centroid: Array
    extent: PlaneExtent
    other_face: int | None
    thickness_m: float | None
    observed_by: list[int]

    @property
    def area_m2(self) -> float:
        """Observed area: holes and doorways do not count."""
        return self.extent.area_m2


@dataclass(eq=False)
class RoomNode:
    """A room or corridor. polygon: (N, 3) on its floor, counter-clockwise seen from above.

    partial: not all of its walls were seen. height_m: None where no ceiling was seen.
    """

    id: int
    name: str
    kind: str
    walls: list[int]
    ground: int | None
    polygon: Array
    centroid: Array
    height_m: float | None
    area_m2: float
    partial: bool
    floor: int | None


@dataclass(eq=False)
class FloorNode:
    """A storey: its rooms, the ground plane they stand on, and their middle."""

    id: int
    rooms: list[int]
    ground: int | None
    centroid: Array


@dataclass(eq=False)
class DoorNode:
    """An opening between two rooms; the second is None while nobody has seen what lies behind it.

    center: (3,) middle of the threshold. normal: (3,) horizontal unit vector through the opening.
    kind: "door" (with a leaf or frame) or "passage". name: by a marker; empty: none.
    """

    id: int
    rooms: tuple[int | None, int | None]
    center: Array
    width_m: float
    height_m: float | None
    normal: Array
    kind: str
    name: str = ""


@dataclass(eq=False)
class MarkerNode:
    """An ArUco marker. id: the printed one. world_from_marker: (4, 4), x to the right of who reads it, y up,
    z out of the paper. name: of what it names, empty: nothing. room: where it hangs; door: which it names.
    """

    id: int
    name: str
    world_from_marker: Array
    size_m: float
    observed_by: list[int]
    room: int | None
    door: int | None = None


@dataclass(eq=False)
class PlaceNode:
    """A point of free space, nothing nearer than clearance_m; neighbours are reached in a straight line."""

    id: int
    position: Array
    clearance_m: float
    room: int | None
    neighbours: list[int]


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
