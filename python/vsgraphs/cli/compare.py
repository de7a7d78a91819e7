"""`vsgraphs eval`: a trajectory against the ground truth, as a table, JSON and a picture."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from vsgraphs.datasets import CAMERAS, icl_nuim, open_sequence, openloris, redwood, replica
from vsgraphs.errors import InputError
from vsgraphs.evaluate import Evaluation, evaluate
from vsgraphs.evaluate.errors import RelativeError, Statistics
from vsgraphs.export.atomic import write_atomically
from vsgraphs.reading import read_head, read_json
from vsgraphs.trajectory import Array, Trajectory, read_tum_trajectory

_PLOTS = (".png", ".svg")


@dataclass
class CompareRequest:
    """What the user asked for."""

    trajectory: Path
    groundtruth: Path
    sequence: Path | None = None
    max_dt_s: float = 0.01
    json_file: Path | None = None
    plot: Path | None = None


def compare(request: CompareRequest, more: dict[str, Any] | None = None) -> Evaluation:
    """Evaluates, prints the table, writes what was asked for (and `more` in the JSON file). Raises
    InputError.
    """
    if request.plot is not None and request.plot.suffix.lower() not in _PLOTS:
        raise InputError(f"--plot {request.plot}: expected a name ending in {' or '.join(_PLOTS)}")
    path = request.trajectory / "trajectory.txt" if request.trajectory.is_dir() else request.trajectory
    estimate = read_tum_trajectory(path)
    truth = read_groundtruth(request.groundtruth)
    stamps = input_stamps(request, path)
    result = evaluate(estimate, truth, max_dt_s=request.max_dt_s, input_stamps=stamps)
    if stamps is None:
        result.completion = _completion_of_run(path)
        if result.completion is None:
            result.notes.append("completion unknown: give --sequence FOLDER to count the input frames")
    _print(result)
    if request.json_file is not None:
        content = {**result.to_json(), **(more or {})}
        write_atomically(request.json_file, json.dumps(content, indent=1) + "\n")
    if request.plot is not None:
        from vsgraphs.evaluate.plot import draw

        write_atomically(request.plot, draw(result, request.plot.suffix[1:].lower()))
        print(f"plot: {request.plot}")
    return result


def required_truth(groundtruth: Path | None, trajectory: Path) -> Path:
    """What --groundtruth says, else the sequence that a run's directory was made from. Raises InputError
    where it is missing.
    """
    if groundtruth is not None:
        return groundtruth
    source = _run_report(trajectory / "run.json").get("source") if trajectory.is_dir() else None
    folder = source.get("path") if isinstance(source, dict) else None
    if not isinstance(folder, str):
        raise InputError("missing --groundtruth: give the true trajectory or the sequence's folder")
    if not Path(folder).is_dir():
        raise InputError(f"missing --groundtruth: {folder}, which the run was made from, is gone")
    return Path(folder)


def read_groundtruth(path: Path) -> Trajectory:
    """The truth from a trajectory file of any format that has one, or from a sequence's folder."""
    if path.is_dir():
        if (path / "groundtruth.txt").is_file() and not openloris.detect(path):
            return read_tum_trajectory(path / "groundtruth.txt")
        truth = open_sequence(path, _ANY_CAMERA).groundtruth
        if truth is None:
            raise InputError(f"the sequence in {path} has no ground truth")
        return truth
    if not path.exists():
        raise InputError(f"ground truth {path} does not exist")
    if path.name.endswith(icl_nuim.TRUTH_SUFFIX):
        return icl_nuim.read_truth(path)
    if path.name == openloris.TRUTH and openloris.detect(path.parent):
        return openloris.read_truth(path)
    if path.name == redwood.TRUTH:
        return read_groundtruth(path.resolve().parent)
    return replica.read_truth(path) if _columns(path) == 16 else read_tum_trajectory(path)


# Only lists are read here, no images.
_ANY_CAMERA = CAMERAS["tum-fr3"]


def input_stamps(request: CompareRequest, trajectory: Path) -> Array | None:
    """Timestamps of the frames the trajectory was made from: (F,) seconds, or None where they cannot be
    known.

    From --sequence, or the sequence in the ground truth's folder; of it, as many frames as the run.json
    beside the trajectory says were used.
    """
    folder = request.sequence
    if folder is None:
        folder = request.groundtruth if request.groundtruth.is_dir() else request.groundtruth.resolve().parent
        try:
            sequence = open_sequence(folder, _ANY_CAMERA)
        except InputError:  # the ground truth lies elsewhere: nothing wrong with that
            return None
    else:
        sequence = open_sequence(folder, _ANY_CAMERA)
    stamps = np.array([frame.timestamp for frame in sequence.frames])
    used = _run_report(trajectory).get("frames")
    return stamps[:used] if isinstance(used, int) and used > 0 else stamps


def _completion_of_run(trajectory: Path) -> float | None:
    completion = _run_report(trajectory).get("completion")
    return float(completion) if isinstance(completion, int | float) else None


def _run_report(trajectory: Path) -> dict[str, Any]:
    try:
        report = read_json(trajectory.parent / "run.json", "report")
    except InputError:
        return {}
    return report if isinstance(report, dict) else {}


def _columns(path: Path) -> int:
    lines = read_head(path, "ground truth").splitlines()
    return next((len(line.split()) for line in lines if line.strip() and line[0] != "#"), 0)


def _print(result: Evaluation) -> None:
    from rich.console import Console
    from rich.table import Table

    console = Console(width=None, highlight=False)
    for note in result.notes:
        console.print(f"note: {note}", markup=False, soft_wrap=True)
    table = Table("", "RMSE", "mean", "median", "max", "unit", box=None, header_style="bold", pad_edge=False)
    for column in table.columns[1:5]:
        column.justify = "right"
    _row(table, "ATE", result.ate, "m")
    for name, error, per in (
        ("RPE per metre", result.rpe_per_metre, "m"),
        ("RPE per second", result.rpe_per_second, "s"),
    ):
        _relative_rows(table, name, error, per)
    console.print(table)
    completion = "unknown" if result.completion is None else f"{100 * result.completion:.2f} %"
    console.print(
        f"completion {completion}; {result.pairs} poses paired over {result.path_m:.2f} m, "
        f"{result.duration_s:.2f} s; rigid alignment, no scale",
        soft_wrap=True,
    )


def _relative_rows(table: Any, name: str, error: RelativeError | None, per: str) -> None:
    if error is None:
        table.add_row(name, "-", "-", "-", "-", f"shorter than 1 {per}")
        return
    _row(table, f"{name}, translation", error.translation, f"m/{per}")
    _row(table, f"{name}, rotation", error.rotation_deg, f"deg/{per}")


def _row(table: Any, name: str, s: Statistics, unit: str) -> None:
    table.add_row(name, f"{s.rmse:.5f}", f"{s.mean:.5f}", f"{s.median:.5f}", f"{s.max:.5f}", unit)
