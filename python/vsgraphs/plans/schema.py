"""What a plan file may hold: one table per object, key -> kind of value.

Kinds: number, whole, text, flag, point (2 numbers), size (3 numbers), colour ("#rrggbb"), points, texts, or
another table ([table] for a list of them). `required` lists the keys without a default; the defaults live in
simulate/plan.h.
"""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Table:
    """An object of the plan: the core's class, its keys, and which keys must be there."""

    cls: str
    keys: dict[str, str | Table | list[Table]]
    required: tuple[str, ...] = ()
    names: dict[str, str] = field(default_factory=dict)  # key -> attribute, where they differ


SLOPE = Table("SlopePlan", {"wall": "whole", "knee": "number", "reach": "number"}, ("wall",))
ROOM = Table(
    "RoomPlan",
    {
        "id": "text",
        "kind": "text",
        "polygon": "points",
        "z_floor": "number",
        "height": "number",
        "level": "whole",
        "counted": "flag",
        "skirting": "flag",
        "floor": "text",
        "ceiling": "text",
        "wall_colour": "colour",
        "brightness": "number",
        "lamps": "points",
        "slope": SLOPE,
    },
    ("id", "polygon"),
)
LEAF = Table(
    "DoorLeafPlan",
    {
        "room": "text",
        "angle_deg": "number",
        "hinge": "text",
        "set_back": "number",
        "pair": "flag",
        "turns": "points",
    },
    ("room",),
)
DOOR = Table(
    "DoorPlan",
    {"rooms": "texts", "at": "point", "width": "number", "height": "number", "leaf": LEAF},
    ("rooms", "at"),
)
WINDOW = Table(
    "WindowPlan",
    {
        "room": "text",
        "wall": "whole",
        "along": "number",
        "width": "number",
        "height": "number",
        "sill": "number",
        "radiator": "flag",
        "curtain": "flag",
        "view": "text",
        "seed": "whole",
    },
    ("room", "wall", "along"),
)
POSTER = Table(
    "PosterPlan",
    {
        "room": "text",
        "wall": "whole",
        "along": "number",
        "z": "number",
        "width": "number",
        "height": "number",
        "kind": "text",
        "seed": "whole",
    },
    ("room", "wall", "along"),
)
MARKER = Table(
    "MarkerPlan",
    {
        "id": "whole",
        "room": "text",
        "wall": "whole",
        "along": "number",
        "z": "number",
        "size_m": "number",
    },
    ("id", "room", "wall", "along"),
    {"size_m": "size"},
)
BOX = Table(
    "BoxPlan",
    {
        "kind": "text",
        "room": "text",
        "at": "point",
        "z": "number",
        "yaw_deg": "number",
        "size": "size",
        "colour": "colour",
        "seed": "whole",
    },
    ("room", "at", "size"),
)
STAIRS = Table(
    "StairsPlan",
    {
        "room": "text",
        "from": "point",
        "to": "point",
        "width": "number",
        "rise": "number",
        "steps": "whole",
        "landing": "number",
    },
    ("room", "from", "to", "rise"),
    {"from": "from_"},
)
PARTITION = Table(
    "PartitionPlan",
    {
        "room": "text",
        "from": "point",
        "to": "point",
        "height": "number",
        "thickness": "number",
        "kind": "text",
        "mullions": "number",
    },
    ("room", "from", "to"),
    {"from": "from_"},
)
MOVER = Table(
    "MoverPlan",
    {
        "kind": "text",
        "room": "text",
        "pose": "text",
        "way": "points",
        "speed": "number",
        "start_s": "number",
        "yaw_deg": "number",
        "seed": "whole",
    },
    ("room", "way"),
)
ROBOT = Table("RobotPlan", {"width": "number", "ahead": "number", "below": "number"})
WAYPOINT = Table(
    "WaypointPlan",
    {
        "at": "point",
        "room": "text",
        "z": "number",
        "look": "point",
        "look_z": "number",
        "yaw_deg": "number",
        "pitch_deg": "number",
        "pause_s": "number",
    },
    ("at",),
)
PATH = Table(
    "PathPlan",
    {
        "eye_height": "number",
        "speed": "number",
        "turn_rate": "number",
        "pitch_deg": "number",
        "shake": "number",
        "smooth_s": "number",
        "clearance": "number",
        "closed": "flag",
        "waypoints": [WAYPOINT],
        "robot": ROBOT,
    },
    ("waypoints",),
)
PLAN = Table(
    "Plan",
    {
        "name": "text",
        "description": "text",
        "seed": "whole",
        "fps": "number",
        "rooms": [ROOM],
        "doors": [DOOR],
        "windows": [WINDOW],
        "posters": [POSTER],
        "markers": [MARKER],
        "boxes": [BOX],
        "stairs": [STAIRS],
        "partitions": [PARTITION],
        "movers": [MOVER],
        "path": PATH,
    },
    ("rooms", "path"),
)
# Read by the loader itself.
CAMERA_KEYS = ("width", "height", "fx", "fy", "cx", "cy")
EXTRA_KEYS = ("rotate_deg", "camera", "sensor", "effects")
COMMENT = "comment"  # allowed in every object, ignored
