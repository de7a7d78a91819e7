"""`vsgraphs eval RUN_DIR`: the trajectory, and the scene graph too where the sequence has a true scene."""

from __future__ import annotations

from typing import Any

from vsgraphs.cli.compare import CompareRequest, compare
from vsgraphs.cli.compare_scene import SceneRequest, score_scene
from vsgraphs.errors import InputError
from vsgraphs.evaluate import Evaluation
from vsgraphs.evaluate.scene import Detection, SceneScores


def compare_run(request: CompareRequest) -> None:
    """Evaluates, prints the tables, writes what was asked for (the scene's scores as "scene"). Raises
    InputError.
    """
    scores = _scene_scores(request)
    result = compare(request, None if scores is None else {"scene": scores.to_json()})
    if scores is not None:
        _print(scores, result)


def _scene_scores(request: CompareRequest) -> SceneScores | None:
    """None where there is no true scene, no scene graph, or one that does not go with the trajectory."""
    given = request.groundtruth
    truth = (given if given.is_dir() else given.parent) / "scene_gt.json"
    run = request.trajectory
    if not ((run / "scene_graph.json").is_file() and truth.is_file()):
        return None
    try:
        return score_scene(SceneRequest(run, truth, given, request.max_dt_s)).scores
    except InputError as error:
        print(f"note: the scene graph is not compared: {error}")
        return None


def _print(scores: SceneScores, result: Evaluation) -> None:
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table

    table = Table("", "found", "false", "mean error", box=SIMPLE_HEAD, header_style="bold", pad_edge=False)
    table.columns[1].justify = table.columns[2].justify = "right"
    table.add_row(*_row("rooms", scores.rooms))
    table.add_row(*_row("doors", scores.doors))
    table.add_row(*_row("rooms' walls", scores.walls))  # one long wall of the map is that of several rooms
    table.add_row(*_row("ground", scores.ground))
    table.add_row(*_row("floors", scores.floors))
    for name, score in scores.structure.items():
        if name not in ("rooms", "doors", "floors"):
            table.add_row(*_row(name, score))
    tracked = "" if result.completion is None else f"{100 * result.completion:.1f} %"
    error = f"ATE {_cm(result.ate.rmse)} over {result.path_m:.1f} m"
    table.add_row("camera", tracked, "", error)
    Console(highlight=False).print(table)


def _row(name: str, score: Detection) -> tuple[Any, ...]:
    if score.detected is None:
        return name, f"- of {score.true}", "-", "not sought"
    style = "green" if score.detected == score.true and not score.false else "yellow"
    found = f"[{style}]{score.detected} of {score.true}[/]"
    errors = [text.format(value) for key, text in _ERRORS if (value := score.mean_error(key)) is not None]
    lengths = [_cm(value) for key in _LENGTHS if (value := score.mean_error(key)) is not None]
    return name, found, str(score.false), ", ".join(lengths + errors)


_LENGTHS = ("offset_m", "height_m", "center_m")
_ERRORS = (("angle_deg", "{:.2f} deg"), ("iou", "IoU {:.3f}"))


def _cm(metres: float) -> str:
    return f"{100 * metres:.2f} cm"
