"""A finished run from its files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from vsgraphs.errors import InputError
from vsgraphs.export.ply import read_ply
from vsgraphs.reading import read_json
from vsgraphs.scene_graph import KeyframeNode, SceneGraph, load_scene_graph, transform_points
from vsgraphs.trajectory import read_tum_trajectory
from vsgraphs.view.layout import gaze_at, layout
from vsgraphs.view.scene import log_constants, log_landmarks, log_path, log_scene
from vsgraphs.view.sinks import Sinks
from vsgraphs.view.surfaces import upright

FILES = ("scene_graph.json", "map.ply", "trajectory.txt")


def recordings(folder: Path) -> list[Path]:
    """What the run recorded in the directory; not what an earlier one did, where run.json tells of none."""
    found = sorted(folder.glob("*.rrd"))
    if found and (folder / "run.json").is_file():
        report = read_json(folder / "run.json", "figures of a run")
        if isinstance(report, dict) and "view" not in report:
            return []
    return found


def check_run(folder: Path) -> None:
    """Raises InputError where the directory holds nothing that could be shown."""
    if not folder.is_dir():
        reason = "is a file" if folder.exists() else "does not exist"
        raise InputError(f"{folder} {reason}; give the directory that `vsgraphs run --out` wrote")
    if not recordings(folder) and not any((folder / name).is_file() for name in FILES):
        raise InputError(f"{folder} holds no run: none of {', '.join(FILES)} is there")


def show_run(folder: Path, sinks: Sinks) -> None:
    """Logs map, trajectory and scene graph of a run. Raises InputError: nothing there, or damaged.

    What `run --record` left there is shown instead: it holds all of that and how it came about.
    """
    check_run(folder)
    recorded = recordings(folder)
    if recorded:
        sinks.tell(f"showing the recording {recorded[-1].name}")
        for stream in sinks.streams:
            stream.log_file_from_path(recorded[-1])
        return
    graph = SceneGraph()
    if (folder / "scene_graph.json").is_file():
        graph = load_scene_graph(folder / "scene_graph.json")
    path = np.zeros((0, 3))
    if (folder / "trajectory.txt").is_file():
        trajectory = read_tum_trajectory(folder / "trajectory.txt")
        path = trajectory.positions
        if not graph.keyframes:  # a map without planes: something to look at
            graph.keyframes = {
                i: KeyframeNode(i, float(s), p)
                for i, (s, p) in enumerate(zip(trajectory.timestamps, trajectory.poses, strict=True))
            }
    up = upright(graph)
    sinks.arrange(layout(gaze_at(graph, up), images=False))
    log_constants(sinks)
    if (folder / "map.ply").is_file():
        points, colours = read_ply(folder / "map.ply")
        log_landmarks(sinks, transform_points(up, points), colours)
    log_path(sinks, transform_points(up, path))
    if graph.planes:
        log_scene(sinks, graph, up)
