"""Planes: building components, and planes that are none (yet)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from vsgraphs.errors import InputError
from vsgraphs.reading import shown
from vsgraphs.scene_graph import levelling
from vsgraphs.scene_graph.colours import CLASS_COLOURS
from vsgraphs.scene_graph.edges import Edge, Relation, node_key
from vsgraphs.scene_graph.extent import PlaneExtent, extent_of
from vsgraphs.scene_graph.kinds import mover, rows
from vsgraphs.scene_graph.kinds.box import Box
from vsgraphs.scene_graph.kinds.kind import Kind, Rgb, SparkPlace, count
from vsgraphs.scene_graph.kinds.mover import Mover, Row
from vsgraphs.trajectory import Array

if TYPE_CHECKING:
    from vsgraphs.scene_graph.graph import SceneGraph

ROLES = ("undecided", "wall", "ground", "ceiling", "door", "window", "other")
OBSERVES_PLANE = Relation("observes_plane", "keyframe", "plane_observation")
ON_GROUND = Relation("wall_perpendicular_to_ground", "plane", "wall_perpendicular_to_ground")
PARALLEL = Relation("parallel", "plane", "wall_pair_parallel", symmetric=True)  # facing walls of one room
PERPENDICULAR = Relation("perpendicular", "plane", "wall_pair_perpendicular", symmetric=True)
OTHER_FACE = Relation("other_face", "plane", symmetric=True)  # two faces of one wall

_MOST_CELLS = 20_000_000
_LARGEST_CELL_M = 10.0


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


_EXTENT = rows.row_of(
    {
        "origin": rows.VECTOR,
        "axis_u": rows.VECTOR,
        "axis_v": rows.VECTOR,
        "polygon": rows.POINTS,
        "runs": {
            "type": "array",
            "items": {"type": "array", "items": {"type": "integer"}, "minItems": 3, "maxItems": 3},
        },
        "cell_m": {"type": "number", "minimum": 0.001},
    },
    description="Observed extent in the plane's own axes u, v. polygon: its convex hull; runs: rows v, first "
    "u, last u of occupied cells of cell_m.",
)
_ROW = rows.row_of(
    {
        "id": rows.ID,
        "role": {"enum": list(ROLES)},
        "votes": {"type": "object", "additionalProperties": rows.NUMBER},
        "normal": rows.VECTOR,
        "offset_m": rows.NUMBER,
        "centroid": rows.VECTOR,
        "extent": {"$ref": "#/$defs/extent"},
        "area_m2": rows.NUMBER,
        "other_face": rows.OPTIONAL_ID,
        "thickness_m": rows.NUMBER_OR_NULL,
        "observed_by": rows.IDS,
    },
    description="One face of a building component: normal . x + offset_m = 0, the normal toward the side "
    "that saw it.",
)


class PlaneKind(Kind[PlaneNode]):
    """Its raw rows: id, role, votes, normal, d, anchor, points (N, 3), other_face, thickness_m and
    observed_by, in the map's frame.
    """

    name, section, node = "plane", "planes", PlaneNode
    required = True
    row, definitions = _ROW, MappingProxyType({"extent": _EXTENT})
    derived = ("area_m2",)
    relations = (OBSERVES_PLANE, ON_GROUND, PARALLEL, PERPENDICULAR, OTHER_FACE)
    colour = CLASS_COLOURS["wall"]
    spark = SparkPlace("objects", "O", ROLES)

    def from_map(self, row: Row, mover: Mover) -> PlaneNode:
        return _from_map(row, mover)

    def references(self, node: PlaneNode) -> Iterator[tuple[str, int | None]]:
        yield "plane", node.other_face
        yield from (("keyframe", number) for number in node.observed_by)

    def edges(self, node: PlaneNode, graph: SceneGraph) -> Iterator[Edge]:
        for keyframe in node.observed_by:
            yield OBSERVES_PLANE.edge(keyframe, node_key("plane", node.id))
        if node.other_face is not None:
            yield OTHER_FACE.between(node.id, node.other_face)

    def problem(self, node: PlaneNode) -> str | None:
        """Surfaces that no building has: of too many cells, or on axes that are none."""
        extent = node.extent
        first, last = extent.runs[:, 1].astype(float), extent.runs[:, 2].astype(float)
        lengths = [float((axis**2).sum()) for axis in (extent.axis_u, extent.axis_v)]
        if (last < first).any() or (last - first + 1).sum() > _MOST_CELLS or extent.cell_m > _LARGEST_CELL_M:
            return "has an extent without cells or of too many"
        if not all(0.9 < length < 1.1 for length in lengths):
            return "has an extent on axes that are not of length 1"
        return None

    def place(self, node: PlaneNode) -> Array:
        return node.centroid

    def title(self, node: PlaneNode, graph: SceneGraph) -> str:
        rooms = [room for room in graph.rooms.values() if node.id in room.walls]
        return f"{node.role} {node.id}" + (f" of {rooms[-1].name}" if rooms and rooms[-1].name else "")

    def label(self, node: PlaneNode) -> str:
        return node.role

    def rgb(self, node: PlaneNode) -> Rgb:
        return CLASS_COLOURS[node.role]

    def box(self, node: PlaneNode, graph: SceneGraph) -> Box:
        rotation = np.stack([node.extent.axis_u, node.extent.axis_v, node.normal], axis=1)
        uv = node.extent.flat(node.extent.polygon)
        low, high = (uv.min(axis=0), uv.max(axis=0)) if len(uv) else (np.zeros(2), np.zeros(2))
        centre = node.extent.lift((low + high)[None] / 2)[0] if len(uv) else node.centroid
        return Box(centre, np.array([*(high - low), 0.0]), rotation)

    def details(self, node: PlaneNode) -> dict[str, Any]:
        return {
            "plane": np.array([*node.normal, node.offset_m]),
            "polygon": node.extent.polygon,
            "area_m2": node.area_m2,
            "other_face": node.other_face,
            "thickness_m": node.thickness_m,
            "observed_by": node.observed_by,
        }

    def figures(self, graph: SceneGraph) -> dict[str, Any]:
        roles = Counter(plane.role for plane in graph.planes.values())
        walls, grounds = roles["wall"], roles["ground"]
        counts = {"planes": len(graph.planes), "undecided": roles["undecided"]}
        return {**counts, "walls": walls, "grounds": grounds}

    def found(self, figures: Mapping[str, Any]) -> str:
        return count(figures.get("walls", 0), "wall")


def _from_map(row: Row, move: Mover) -> PlaneNode:
    what = f"plane {row['id']}"
    if row["role"] not in ROLES:
        raise InputError(f"{what}: unknown role {shown(row['role'])}; known: {', '.join(ROLES)}")
    normal = mover.vector(row["normal"], f"{what}: normal")
    if abs(np.linalg.norm(normal) - 1) > 1e-3:
        raise InputError(f"{what}: its normal has length {np.linalg.norm(normal):g}, expected 1")
    normal, offset_m = levelling.transform_plane(move.transform, normal, float(row["d"]))
    points = move.points(row.get("points", ()), f"{what}: points")
    extent = extent_of(points, normal, offset_m, move.frame.up)
    middle = extent.cell_centres().mean(axis=0) if len(extent.runs) else move.point(row["anchor"], what)
    thick = row.get("other_face") is not None
    return PlaneNode(
        id=row["id"],
        role=row["role"],
        votes={role: float(votes) for role, votes in sorted((row.get("votes") or {}).items())},
        normal=mover.finite(normal, what),
        offset_m=offset_m,
        centroid=middle - normal * float(normal @ middle + offset_m),
        extent=extent,
        other_face=mover.id_or_none(row.get("other_face")),
        thickness_m=mover.number_or_none(row.get("thickness_m")) if thick else None,
        observed_by=move.observers(row),
    )
