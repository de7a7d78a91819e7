"""`vsgraphs eval --scene`: a run's scene graph against the true scene, as a table and JSON."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from vsgraphs.cli.compare import read_groundtruth
from vsgraphs.errors import InputError
from vsgraphs.evaluate import MAX_DT_S, Evaluation, associate, evaluate
from vsgraphs.evaluate.scene import (
    Detection,
    SceneOptions,
    SceneScores,
    align_poses,
    evaluate_scene,
    load_scene_truth,
    options_from,
    trajectory_from_graph,
)
from vsgraphs.export.atomic import write_atomically
from vsgraphs.export.ply import read_ply
from vsgraphs.scene_graph import load_scene_graph
from vsgraphs.trajectory import Array, read_tum_trajectory


@dataclass
class SceneRequest:
    """What the user asked for."""

    run: Path
    truth: Path
    groundtruth: Path
    max_dt_s: float = MAX_DT_S
    json_file: Path | None = None
    options: SceneOptions = field(default_factory=SceneOptions)


def scene_request(
    scene: Path | None,
    truth: Path | None,
    groundtruth: Path | None,
    max_dt_s: float,
    json_file: Path | None,
    tolerances: list[str],
    plot: Path | None,
) -> SceneRequest:
    """From the command's options. Raises InputError."""
    if scene is None or truth is None:
        missing = "--scene RUN_DIR" if scene is None else "--truth scene_gt.json"
        raise InputError(f"--scene and --truth go together: {missing} is missing")
    if plot is not None:
        raise InputError("--plot draws trajectories: leave it out with --scene")
    beside = truth.parent / "groundtruth.txt"
    if groundtruth is None and not beside.is_file():
        raise InputError(f"no groundtruth.txt beside {truth}: give the true trajectory with --groundtruth")
    return SceneRequest(scene, truth, groundtruth or beside, max_dt_s, json_file, options_from(tolerances))


@dataclass
class SceneComparison:
    """scores; accuracy: of the trajectory. truth_from_graph: (4, 4), by the trajectory alone."""

    scores: SceneScores
    accuracy: Evaluation
    truth_from_graph: Array


def compare_scene(request: SceneRequest) -> SceneScores:
    """Evaluates, prints the table, writes the JSON file. Raises InputError."""
    found = score_scene(request)
    _print(found.scores, found.accuracy)
    if request.json_file is not None:
        content = {
            "ate_rmse_m": found.accuracy.ate.rmse,
            **found.scores.to_json(),
            "tolerances": vars(request.options),
            "alignment_truth_from_graph": np.round(found.truth_from_graph, 9).tolist(),
        }
        write_atomically(request.json_file, json.dumps(content, indent=1) + "\n")
    return found.scores


def score_scene(request: SceneRequest) -> SceneComparison:
    """Evaluates. Raises InputError."""
    graph = load_scene_graph(request.run / "scene_graph.json")
    truth = load_scene_truth(request.truth)
    estimate = read_tum_trajectory(request.run / "trajectory.txt")
    true_poses = read_groundtruth(request.groundtruth)
    accuracy = evaluate(estimate, true_poses, max_dt_s=request.max_dt_s)
    mine, theirs = associate(estimate.timestamps, true_poses.timestamps, request.max_dt_s)
    truth_from_trajectory = align_poses(estimate.poses[mine], true_poses.poses[theirs])
    to_trajectory = trajectory_from_graph(graph, estimate)
    map_file = request.run / "map.ply"
    # The map's points are written in the trajectory's frame, whichever that is.
    points = None
    if map_file.exists():
        points = read_ply(map_file)[0]
        points = (points - to_trajectory[:3, 3]) @ to_trajectory[:3, :3]
    truth_from_graph = truth_from_trajectory @ to_trajectory
    scores = evaluate_scene(
        graph,
        truth,
        truth_from_graph,
        ate_m=accuracy.ate.rmse,
        map_points=points,
        options=request.options,
    )
    scores.notes += accuracy.notes
    if points is None:
        scores.notes.append(f"no {map_file}: map points are not scored")
    return SceneComparison(scores, accuracy, truth_from_graph)


def _print(scores: SceneScores, accuracy: Evaluation) -> None:
    from rich.console import Console
    from rich.table import Table

    console = Console(width=None, highlight=False)
    for note in scores.notes:
        console.print(f"note: {note}", markup=False, soft_wrap=True)
    heads = ("", "found/true", "false", "prec.", "recall", "F1", "mean error")
    table = Table(*heads, box=None, header_style="bold", pad_edge=False)
    for column in table.columns[1:6]:
        column.justify = "right"
    for column in table.columns:
        column.no_wrap = True
    _row(table, "components", scores.building_components)
    _row(table, "  walls", scores.walls)
    _row(table, "  ground", scores.ground)
    for name, score in scores.structure.items():
        _row(table, name, score)
    console.print(table)
    found = scores.map
    if found is not None:
        structural = "-" if found.structural_rmse_m is None else f"{found.structural_rmse_m:.4f} m"
        console.print(
            f"map: {found.points} points, {structural} RMSE of the {found.structural_points} at most "
            f"{found.near_m:g} m from a wall, floor or ceiling; {100 * found.share_within:.1f} % within "
            f"{found.within_m:g} m; {found.rmse_m:.4f} m RMSE of all, furniture included",
            soft_wrap=True,
        )
    console.print(
        f"aligned by the trajectory (rigid, no scale; ATE {accuracy.ate.rmse:.4f} m); planes within "
        f"{scores.offset_tolerance_m:.2f} m count",
        soft_wrap=True,
    )


_UNITS = {
    "angle_deg": "{:.2f} deg",
    "offset_m": "{:.3f} m",
    "iou": "IoU {:.3f}",
    "centroid_m": "centre {:.3f} m",
    "height_m": "{:.3f} m",
    "center_m": "{:.3f} m",
}


def _row(table: Any, name: str, score: Detection) -> None:
    if not score.estimated:
        table.add_row(name, f"- / {score.true}", "-", "-", "-", "-", "not estimated")
        return
    errors = [
        _UNITS[key].format(value) for key in score.error_names if (value := score.mean_error(key)) is not None
    ]
    numbers = (score.precision, score.recall, score.f1)
    texts = ["-" if value is None else f"{value:.2f}" for value in numbers]
    table.add_row(name, f"{score.detected} / {score.true}", str(score.false), *texts, ", ".join(errors))
