"""A scene graph against the true scene."""

from __future__ import annotations

import numpy as np

from vsgraphs.evaluate.scene.components import aligned, score_ground, score_walls
from vsgraphs.evaluate.scene.elements import score_by_middle, score_doors, score_floors, score_rooms
from vsgraphs.evaluate.scene.map_points import score_map
from vsgraphs.evaluate.scene.options import SceneOptions
from vsgraphs.evaluate.scene.scores import Detection, SceneScores
from vsgraphs.evaluate.scene.truth import SceneTruth
from vsgraphs.scene_graph import KINDS, SceneGraph, transform_points
from vsgraphs.trajectory import Array

_DEFAULTS = SceneOptions()


def evaluate_scene(
    graph: SceneGraph,
    truth: SceneTruth,
    alignment: Array,
    *,
    ate_m: float | None = None,
    map_points: Array | None = None,
    options: SceneOptions = _DEFAULTS,
) -> SceneScores:
    """Scores walls, grounds, rooms, floors, doors, what else the truth lists, and the map's points.

    alignment: (4, 4) truth_from_graph, of the trajectory (`align_poses`), never of the planes. ate_m: the
    trajectory's ATE, which loosens the offset tolerance (SceneOptions). map_points: (M, 3) in the graph's
    frame.
    """
    tolerance_m = options.offset_tolerance_m(ate_m)
    walls = [aligned(plane, alignment) for plane in graph.planes_of("wall")]
    grounds = [aligned(plane, alignment) for plane in graph.planes_of("ground")]
    points = None if map_points is None else transform_points(alignment, np.asarray(map_points))
    return SceneScores(
        walls=score_walls(walls, truth, tolerance_m, options),
        ground=score_ground(grounds, truth, tolerance_m, options),
        structure=_structure(graph, truth, alignment, options),
        map=None if points is None else score_map(points, truth, options),
        offset_tolerance_m=tolerance_m,
    )


def _structure(
    graph: SceneGraph, truth: SceneTruth, alignment: Array, options: SceneOptions
) -> dict[str, Detection]:
    rooms = score_rooms(graph, truth, alignment, options)
    scores = {
        "rooms": rooms,
        "floors": score_floors(graph, truth, alignment, options),
        "doors": score_doors(graph, truth, alignment, options, rooms),
    }
    for kind in KINDS:
        score = score_by_middle(kind, graph, truth, alignment)
        if score is not None:
            scores[kind.section] = score
    return scores
