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
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from vsgraphs.cli.result_folder import ResultFolder, Write
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


# What cannot be had again comes first, then what makes it worth having; the rest can be told from the atlas.
_FIRST = ("trajectory.txt", "scene_graph.json")
_SCENE_FILES = ("floorplan.svg", "planes.ply", "scene_graph.dsg.json")


def expected_files(mode: str, atlas: Path | None) -> list[str]:
    """What a run in `system.mode` leaves, in the order it is written in."""
    names = [*_FIRST, *([str(atlas)] if atlas else []), "run.json", "keyframes.txt", "map.ply", *_SCENE_FILES]
    without = () if mode != "slam" else ("scene_graph.json", *_SCENE_FILES)
    return [name for name in (*names, "timeline.json") if name not in without]


def write_results(
    outcome: RunOutcome, folder: ResultFolder, atlas: Sequence[tuple[str, Write]], show: Callable[[str], None]
) -> dict[str, Any]:
    """Writes all files, what matters most first; returns run.json's content.

    atlas: how it is written, or nothing. When a file cannot be written the others are still tried: see
    `folder.failure`. show: what is being done. Raises what is wrong with the scene graph, after all else.
    """
    scene = _Scene(outcome)
    report: dict[str, Any] = {}

    def figures() -> str:
        report.update(run_report(outcome, len(scene.stamps), scene.counts, scene.graph))
        report["warnings"] += folder.warnings
        return json.dumps(report, indent=1) + "\n"

    files = scene.files(outcome)
    files["timeline.json"] = lambda: format_timeline(_spans(outcome))
    remove_earlier(folder.folder, {*files, "run.json"})
    first = [(name, _file(name, files.pop(name))) for name in _FIRST if name in files]
    run_json = [("run.json", _file("run.json", figures))]
    folder.write([*first, *atlas, *run_json], show)
    if outcome.view is not None:
        if outcome.view.report() is not None:
            show("closing the view")
        outcome.view.close()  # what came of it is written too
    folder.write([(name, _file(name, content)) for name, content in files.items()], show)
    folder.write(run_json, show)  # again, with the CPU and memory of the whole process
    if scene.trouble is not None:
        raise scene.trouble
    return report


def _file(name: str, content: Callable[[], str | bytes]) -> Write:
    return lambda folder: write_atomically(folder / name, content())


class _Scene:
    """What is known at the end, in the levelled frame of the scene graph if there is one."""

    def __init__(self, outcome: RunOutcome) -> None:
        snapshot = outcome.slam.snapshot()
        self.stamps, self.poses = outcome.slam.trajectory()
        ids, self.keyframe_stamps, self.keyframe_poses = snapshot.keyframes()
        self.positions, self.colours = snapshot.landmarks()
        self.counts = (len(self.keyframe_stamps), len(self.positions))
        self.graph: SceneGraph | None = None
        self.trouble: Exception | None = None
        if outcome.config.get("system.mode") == "slam":
            return
        try:
            raw = snapshot.scene_graph()
            self.graph = _scene_graph(outcome, raw, (ids, self.keyframe_stamps, self.keyframe_poses))
        except Exception as error:  # the trajectory is worth having without it, in the map's own frame
            self.trouble = error
            return
        self.poses = self.graph.poses_from_map(self.poses)
        self.keyframe_poses = self.graph.poses_from_map(self.keyframe_poses)
        self.positions = self.graph.points_from_map(self.positions)

    def files(self, outcome: RunOutcome) -> dict[str, Callable[[], str | bytes]]:
        graph = self.graph

        def points() -> bytes:
            if graph is not None and outcome.map_colours == "class":
                return format_ply(self.positions, class_colours(graph, self.positions))
            return format_ply(self.positions, self.colours)

        return {
            "trajectory.txt": lambda: format_tum(self.stamps, self.poses),
            "keyframes.txt": lambda: format_tum(self.keyframe_stamps, self.keyframe_poses),
            "map.ply": points,
            **(_scene_files(graph, self.poses) if graph is not None else {}),
        }


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
        "floorplan.svg": lambda: format_floorplan(graph, poses[:, :3, 3]),
        "planes.ply": lambda: format_planes_ply(graph),
        "scene_graph.dsg.json": lambda: format_spark_dsg(graph),
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
    outcome: RunOutcome, tracked: int, mapped: tuple[int, int], graph: SceneGraph | None
) -> dict[str, Any]:
    """run.json: figures, then what is needed to repeat them. mapped: keyframes, landmarks."""
    keyframes, landmarks = mapped
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
