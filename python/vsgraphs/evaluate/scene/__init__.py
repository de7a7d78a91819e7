"""Scores of scene graphs: building components, structural elements, map points."""

from vsgraphs.evaluate.scene.frames import align_poses, trajectory_from_graph
from vsgraphs.evaluate.scene.options import SceneOptions, options_from
from vsgraphs.evaluate.scene.scores import Detection, MapScore, Match, SceneScores
from vsgraphs.evaluate.scene.scoring import evaluate_scene
from vsgraphs.evaluate.scene.truth import SceneTruth, load_scene_truth, parse_scene_truth

__all__ = [
    "Detection",
    "MapScore",
    "Match",
    "SceneOptions",
    "SceneScores",
    "SceneTruth",
    "align_poses",
    "evaluate_scene",
    "load_scene_truth",
    "options_from",
    "parse_scene_truth",
    "trajectory_from_graph",
]
