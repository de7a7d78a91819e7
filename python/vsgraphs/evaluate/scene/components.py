"""Building components: which true wall or ground each estimated plane is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from vsgraphs.evaluate.scene.options import SceneOptions
from vsgraphs.evaluate.scene.scores import Detection, Match
from vsgraphs.evaluate.scene.truth import SceneTruth, TrueGround, TrueWall
from vsgraphs.scene_graph import PlaneNode, inside_polygon, transform_plane, transform_points
from vsgraphs.trajectory import Array

_BIN_M = 0.1
_COARSE_M = 0.25
_ERRORS = ("angle_deg", "offset_m")


@dataclass(eq=False)
class AlignedPlane:
    """An estimated plane in the truth's frame. cells: (C, 3) middles of its observed cells."""

    id: int
    normal: Array
    offset_m: float
    cells: Array


@dataclass(eq=False)
class _Candidate:
    """An estimated plane that may be a true one. size: of what they share. where: the piece, for gaps."""

    plane: int
    size: float
    errors: dict[str, float]
    where: Any


def aligned(plane: PlaneNode, truth_from_graph: Array) -> AlignedPlane:
    """The plane in the truth's frame."""
    normal, offset_m = transform_plane(truth_from_graph, plane.normal, plane.offset_m)
    return AlignedPlane(
        plane.id, normal, offset_m, transform_points(truth_from_graph, plane.extent.cell_centres())
    )


def score_walls(
    planes: Sequence[AlignedPlane], truth: SceneTruth, tolerance_m: float, options: SceneOptions
) -> Detection:
    """Each face of each wall by itself."""

    def candidate(plane: AlignedPlane, wall: TrueWall) -> _Candidate | None:
        return _as_wall(plane, wall, tolerance_m, options)

    return _score(planes, truth.walls, candidate, _gap_along, options.piece_gap_m)


def score_ground(
    planes: Sequence[AlignedPlane], truth: SceneTruth, tolerance_m: float, options: SceneOptions
) -> Detection:
    """Coplanar floors are one ground."""

    def candidate(plane: AlignedPlane, ground: TrueGround) -> _Candidate | None:
        return _as_ground(plane, ground, tolerance_m, options)

    return _score(planes, truth.grounds, candidate, _gap_across, options.piece_gap_m)


def _score(
    planes: Sequence[AlignedPlane],
    entities: Sequence[Any],
    candidate: Callable[[AlignedPlane, Any], _Candidate | None],
    gap_m: Callable[[Any, Any], float],
    piece_gap_m: float,
) -> Detection:
    """The largest piece of a true entity finds it; others far enough from those taken are pieces of it too,
    nearer ones are duplicates. One plane may find several coplanar entities.
    """
    score = Detection(true=sum(entity.required for entity in entities), error_names=_ERRORS)
    correct: set[int] = set()
    unscored: set[int] = set()
    repeated: set[int] = set()
    for entity in entities:
        found = [c for c in (candidate(plane, entity) for plane in planes) if c is not None]
        if not entity.required:
            unscored.update(c.plane for c in found)
            continue
        taken: list[_Candidate] = []
        for piece in sorted(found, key=lambda c: (-c.size, c.errors["offset_m"], c.plane)):
            if all(gap_m(piece.where, other.where) > piece_gap_m for other in taken):
                taken.append(piece)
            else:
                repeated.add(piece.plane)
        correct.update(piece.plane for piece in taken)
        score.matches += [Match(piece.plane, entity.id, piece.errors) for piece in taken[:1]]
    score.correct = len(correct)
    score.ignored = len(unscored - correct)
    score.false = len(planes) - len(correct) - score.ignored
    score.duplicates = len(repeated - correct - unscored)
    return score


def _as_wall(
    plane: AlignedPlane, wall: TrueWall, tolerance_m: float, options: SceneOptions
) -> _Candidate | None:
    angle = _angle_deg(plane.normal, wall.normal)  # a wall seen from behind has the opposite normal
    offset = abs(float(plane.normal @ wall.middle + plane.offset_m))
    if angle > options.angle_deg or offset > tolerance_m or not len(plane.cells):
        return None
    away = plane.cells - wall.start
    bins = np.floor(away @ wall.along / _BIN_M).astype(np.int64)
    extent_m = len(np.unique(bins)) * _BIN_M
    on_wall = (away[:, 2] > 0) & (away[:, 2] < wall.height_m)
    on_wall &= (bins >= 0) & (bins * _BIN_M < wall.length_m)
    common = np.unique(bins[on_wall])
    overlap_m = len(common) * _BIN_M
    if not len(common) or overlap_m < options.overlap * min(wall.length_m, extent_m):
        return None
    where = (float(common[0] * _BIN_M), float((common[-1] + 1) * _BIN_M))
    return _Candidate(plane.id, overlap_m, {"angle_deg": angle, "offset_m": offset}, where)


def _gap_along(a: tuple[float, float], b: tuple[float, float]) -> float:
    return max(a[0] - b[1], b[0] - a[1])


def _as_ground(
    plane: AlignedPlane, ground: TrueGround, tolerance_m: float, options: SceneOptions
) -> _Candidate | None:
    angle = _angle_deg(plane.normal, np.array([0.0, 0.0, 1.0]))
    if angle > options.angle_deg or not len(plane.cells):
        return None
    inside = np.zeros(len(plane.cells), dtype=bool)
    for room in ground.rooms:
        inside |= inside_polygon(plane.cells[:, :2], room.polygon)
    if inside.mean() < options.overlap:
        return None
    middle = plane.cells[inside].mean(axis=0) * (1, 1, 0) + np.array([0.0, 0.0, ground.z])
    offset = abs(float(plane.normal @ middle + plane.offset_m))
    if offset > tolerance_m:
        return None
    where = np.unique(np.round(plane.cells[inside][:, :2] / _COARSE_M), axis=0) * _COARSE_M
    return _Candidate(plane.id, float(inside.sum()), {"angle_deg": angle, "offset_m": offset}, where)


def _gap_across(a: Array, b: Array) -> float:
    return min(float(np.linalg.norm(b - point, axis=1).min()) for point in a)


def _angle_deg(a: Array, b: Array) -> float:
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b)))
