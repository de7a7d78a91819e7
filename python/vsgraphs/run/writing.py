"""The files a run leaves behind, what matters most first."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from vsgraphs.export.atomic import write_atomically
from vsgraphs.export.class_colours import class_colours
from vsgraphs.export.floorplan import format_floorplan
from vsgraphs.export.planes_ply import format_planes_ply
from vsgraphs.export.ply import format_ply
from vsgraphs.export.spark_dsg import format_spark_dsg
from vsgraphs.export.timeline import format_timeline
from vsgraphs.run.levelling import Levelled
from vsgraphs.run.output import remove_earlier
from vsgraphs.run.report import run_report
from vsgraphs.run.result import Result
from vsgraphs.scene_graph import SceneGraph, format_scene_graph
from vsgraphs.trajectory import Trajectory, format_tum

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from vsgraphs.run.extensions import Extensions
    from vsgraphs.run.listener import Listener
    from vsgraphs.run.outcome import RunOutcome
    from vsgraphs.run.result_folder import ResultFolder, Write

# What cannot be had again comes first, then what makes it worth having; the rest can be told from the atlas.
_FIRST = ("trajectory.txt", "scene_graph.json")
_SCENE_FILES = ("floorplan.svg", "planes.ply", "scene_graph.dsg.json")


def expected_files(mode: str, atlas: Path | None) -> list[str]:
    """What a run in `system.mode` leaves, in the order it is written in."""
    names = [*_FIRST, *([str(atlas)] if atlas else []), "run.json", "keyframes.txt", "map.ply", *_SCENE_FILES]
    without = () if mode != "slam" else ("scene_graph.json", *_SCENE_FILES)
    return [name for name in (*names, "timeline.json") if name not in without]


def write_results(
    outcome: RunOutcome,
    folder: ResultFolder,
    atlas: Sequence[tuple[str, Write]],
    extensions: Extensions,
    listener: Listener,
) -> Result:
    """Writes all files, what matters most first.

    atlas: how it is written, or nothing. When a file cannot be written the others are still tried: see
    `folder.failure`. What is wrong with the scene graph is the result's failure.
    """
    scene = Levelled(outcome.slam, outcome.config.get("system.mode"), outcome.markers)
    result = Result(folder.folder, scene.trajectory, scene.keyframes, scene.graph, failure=scene.trouble)

    def figures() -> str:
        result.info.update(run_report(outcome, scene))
        result.info.update(extensions.report())
        result.info["warnings"] += [*folder.warnings, *extensions.warnings]
        return json.dumps(result.info, indent=1) + "\n"

    files = _files(outcome, scene)
    remove_earlier(folder.folder, {*files, "run.json"}, listener.event)
    first = [(name, _file(name, files.pop(name))) for name in _FIRST if name in files]
    run_json = [("run.json", _file("run.json", figures))]
    folder.write([*first, *atlas, *run_json], listener.doing)
    if outcome.view is not None:
        if outcome.view.report() is not None:
            listener.doing("closing the view")
        outcome.view.close()  # what came of it is written too
    folder.write([(name, _file(name, content)) for name, content in files.items()], listener.doing)
    result.folder, result.files = folder.folder, folder.files()
    extensions.run(result, folder, listener)
    folder.write(run_json, listener.doing)  # again, with the CPU and memory of the whole process
    result.folder, result.files = folder.folder, folder.files()
    return result


def _file(name: str, content: Callable[[], str | bytes]) -> Write:
    return lambda folder: write_atomically(folder / name, content())


def _files(outcome: RunOutcome, scene: Levelled) -> dict[str, Callable[[], str | bytes]]:
    """All but run.json, by name."""
    graph = scene.graph

    def points() -> bytes:
        if graph is not None and outcome.map_colours == "class":
            return format_ply(scene.positions, class_colours(graph, scene.positions))
        return format_ply(scene.positions, scene.colours)

    return {
        "trajectory.txt": lambda: _tum(scene.trajectory),
        "keyframes.txt": lambda: _tum(scene.keyframes),
        "map.ply": points,
        **(_scene_files(graph, scene.trajectory.positions) if graph is not None else {}),
        "timeline.json": lambda: format_timeline(outcome.spans()),
    }


def _tum(trajectory: Trajectory) -> str:
    return format_tum(trajectory.timestamps, trajectory.poses)


def _scene_files(graph: SceneGraph, positions: Any) -> dict[str, Callable[[], str | bytes]]:
    """What shows the scene graph; all in the graph's frame, like the camera's positions."""
    return {
        "scene_graph.json": lambda: format_scene_graph(graph),
        "floorplan.svg": lambda: format_floorplan(graph, positions),
        "planes.ply": lambda: format_planes_ply(graph),
        "scene_graph.dsg.json": lambda: format_spark_dsg(graph),
    }
