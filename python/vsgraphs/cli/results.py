"""The files a run leaves behind."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from vsgraphs.cli import measures
from vsgraphs.cli.output import remove_earlier
from vsgraphs.cli.summary import what_is_missing
from vsgraphs.compiled import core
from vsgraphs.errors import InputError
from vsgraphs.export.atomic import write_atomically
from vsgraphs.export.class_colours import class_colours
from vsgraphs.export.floorplan import format_floorplan
from vsgraphs.export.planes_ply import format_planes_ply
from vsgraphs.export.ply import format_ply
from vsgraphs.export.spark_dsg import format_spark_dsg
from vsgraphs.export.timeline import Span, format_timeline
from vsgraphs.scene_graph import SceneGraph, format_scene_graph
from vsgraphs.trajectory import format_tum
from vsgraphs.version import commit, versions

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from vsgraphs.cli.session import Tally
    from vsgraphs.cli.viewing import RunView
    from vsgraphs.datasets import RecordedSequence
    from vsgraphs.markers import KeyframeMarkers, MarkerRegistry
    from vsgraphs.segment import KeyframeSegmentation


@dataclass
class MarkerOutcome:
    """What a run knows of markers beyond the map. warnings: of naming; there once the files were written."""

    file: str  # as the user named it
    registry: MarkerRegistry
    search: KeyframeMarkers
    warnings: list[str] = field(default_factory=list)


@dataclass
class RunOutcome:
    """A finished run, before it is written."""

    out: Path
    sequence: RecordedSequence
    config: Any
    slam: Any
    tally: Tally
    frames: int
    wall_s: float
    startup_s: float | None
    map_colours: str = "image"  # of map.ply: image or class
    segmenter: str = "geometry"  # as the user named it
    segmentation: KeyframeSegmentation | None = None
    view: RunView | None = None
    markers: MarkerOutcome | None = None
    warnings: list[str] = field(default_factory=list)  # of saving meanwhile


def write_results(outcome: RunOutcome) -> dict[str, Any]:
    """Writes all files, the trajectory first; returns run.json's content.

    When one cannot be written the others are still tried; then InputError names all that are missing.
    """
    slam = outcome.slam
    snapshot = slam.snapshot()
    stamps, poses = slam.trajectory()
    ids, keyframe_stamps, keyframe_poses = snapshot.keyframes()
    positions, colours = snapshot.landmarks()
    graph = None
    if outcome.config.get("system.mode") != "slam":
        graph = _scene_graph(outcome, snapshot.scene_graph(), (ids, keyframe_stamps, keyframe_poses))
        poses, keyframe_poses = graph.poses_from_map(poses), graph.poses_from_map(keyframe_poses)
        positions = graph.points_from_map(positions)
        if outcome.map_colours == "class":
            colours = class_colours(graph, positions)
    report: dict[str, Any] = {}

    def figures() -> str:  # last, so that CPU and memory are those of the whole process
        report.update(run_report(outcome, len(stamps), len(keyframe_stamps), len(positions), graph))
        return json.dumps(report, indent=1) + "\n"

    contents: dict[str, Callable[[], str | bytes]] = {
        "trajectory.txt": lambda: format_tum(stamps, poses),
        "keyframes.txt": lambda: format_tum(keyframe_stamps, keyframe_poses),
        "map.ply": lambda: format_ply(positions, colours),
        **(_scene_files(graph, poses) if graph is not None else {}),
        "timeline.json": lambda: format_timeline(_spans(outcome)),
        "run.json": figures,
    }
    remove_earlier(outcome.out, contents)
    failures = []
    for name, content in contents.items():
        try:
            write_atomically(outcome.out / name, content())
        except InputError as error:
            failures.append((name, str(error)))
    if failures:
        others = [name for name, _ in failures[1:]]
        kept = [name for name in contents if name not in dict(failures)]
        raise InputError(
            failures[0][1]
            + (f", nor {', '.join(others)}" if others else "")
            + (f"; written: {', '.join(kept)}" if kept else "; nothing was written")
        )
    return report


def _scene_graph(outcome: RunOutcome, raw: dict[str, Any], keyframes: tuple[Any, Any, Any]) -> SceneGraph:
    """The map's graph; with a marker file, named by it."""
    markers = outcome.markers
    if markers is None:
        return SceneGraph.from_map(raw, keyframes)
    from vsgraphs.markers import name_by_markers, told_of_two_places

    graph = SceneGraph.from_map({**raw, "markers": raw["markers"] or []}, keyframes)  # they were looked for
    markers.warnings = told_of_two_places(raw) + name_by_markers(graph, markers.registry)
    return graph


def _marker_figures(outcome: RunOutcome, graph: SceneGraph | None) -> dict[str, Any]:
    markers = outcome.markers
    if markers is None:
        return {}
    nodes = graph.markers.values() if graph is not None else ()
    mapped = [{"id": node.id, "name": node.name, "keyframes": len(node.observed_by)} for node in nodes]
    figures = {"file": markers.file, "dictionary": markers.registry.dictionary, **markers.search.report()}
    return {"markers": {**figures, "mapped": mapped}}


def _scene_files(graph: SceneGraph, poses: Any) -> dict[str, Callable[[], str | bytes]]:
    """What shows the scene graph; all in the graph's frame, like the trajectory."""
    return {
        "scene_graph.json": lambda: format_scene_graph(graph),
        "scene_graph.dsg.json": lambda: format_spark_dsg(graph),
        "floorplan.svg": lambda: format_floorplan(graph, poses[:, :3, 3]),
        "planes.ply": lambda: format_planes_ply(graph),
    }


def _scene_counts(graph: SceneGraph | None) -> dict[str, Any]:
    """How many of each kind of surface and structure, and in which frame all files are."""
    if graph is None:
        return {"frame": "first_camera"}
    roles = Counter(plane.role for plane in graph.planes.values())
    return {
        "frame": "levelled" if graph.frame.levelled else "first_camera",
        "planes": len(graph.planes),
        "undecided": roles["undecided"],
        "walls": roles["wall"],
        "grounds": roles["ground"],
        "rooms": len(graph.rooms),
        "partial_rooms": sum(room.partial for room in graph.rooms.values()),
        "area_m2": sum(room.area_m2 for room in graph.rooms.values()),
        "floors": len(graph.floors),
        "doors": len(graph.doors),
    }


def run_report(
    outcome: RunOutcome, tracked: int, keyframes: int, landmarks: int, graph: SceneGraph | None
) -> dict[str, Any]:
    """run.json: figures, then what is needed to repeat them."""
    statistics = outcome.slam.statistics()
    processed = outcome.tally.seen
    shown = outcome.view.report() if outcome.view else None
    report: dict[str, Any] = {
        "frames": outcome.frames,
        "tracked": tracked,
        "completion": tracked / outcome.frames if outcome.frames else 0.0,
        "skipped": dict(sorted({**outcome.sequence.skipped, **outcome.tally.skipped}.items())),
        "keyframes": keyframes,
        "landmarks": landmarks,
        "maps": statistics["maps"],
        "loops": statistics["loops"],
        "merges": statistics["merges"],
        "loop_candidates": statistics["loop_candidates"],
        "join_candidates": statistics["join_candidates"],
        "scene": _scene_counts(graph),
        "wall_s": outcome.wall_s,
        "waited_s": float(statistics["waited_s"]),
        "cpu_s": measures.cpu_s(),
        "fps": processed / outcome.wall_s if outcome.wall_s > 0 else 0.0,
        "peak_memory_mb": measures.peak_memory_mb(),
        "startup_s": outcome.startup_s,
        "ended": datetime.now(UTC).isoformat(timespec="seconds"),
        "interrupted": outcome.tally.interrupted,
        "stages": statistics["stages"],
        "segmentation": {
            "backend": outcome.segmenter,
            **(outcome.segmentation.report() if outcome.segmentation else {}),
        },
        **({"view": shown} if shown else {}),
        **_marker_figures(outcome, graph),
        "source": {
            "name": outcome.sequence.name,
            "path": str(outcome.sequence.path.resolve()),
            "format": outcome.sequence.format,
            "camera": outcome.sequence.calibration.origin,
        },
        "versions": versions(core()),
        "commit": commit(core()),
        "configuration": {key: outcome.config.get(key) for key in outcome.config.keys()},  # noqa: SIM118
        "seed": outcome.config.get("system.seed"),
        "warnings": [
            *outcome.sequence.warnings,
            *outcome.tally.warnings,
            *outcome.warnings,
            *(outcome.segmentation.warnings if outcome.segmentation else ()),
            *(outcome.view.warnings if outcome.view else ()),
            *([*outcome.markers.search.warnings, *outcome.markers.warnings] if outcome.markers else ()),
            *statistics["warnings"],
        ],
    }
    report["warnings"] += what_is_missing(report)
    return report


def _spans(outcome: RunOutcome) -> list[Span]:
    spans: list[Span] = [tuple(span) for span in outcome.slam.trace()]
    spans += [("decoding", "decode", *span) for span in outcome.tally.decode_spans]
    if outcome.markers is not None:
        spans += [("markers", "search", *span) for span in outcome.markers.search.spans]
    if outcome.segmentation is not None:
        spans += [("segmentation", "segment", *span) for span in outcome.segmentation.spans]
    return spans
