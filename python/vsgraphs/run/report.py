"""run.json: how a run went, and what is needed to repeat it."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from vsgraphs.compiled import core
from vsgraphs.run import measures
from vsgraphs.run.naming import marker_figures
from vsgraphs.run.summary import what_is_missing
from vsgraphs.scene_graph import KINDS
from vsgraphs.version import commit, versions

if TYPE_CHECKING:
    from vsgraphs.run.levelling import Levelled
    from vsgraphs.run.outcome import RunOutcome
    from vsgraphs.scene_graph import SceneGraph


def run_report(outcome: RunOutcome, scene: Levelled) -> dict[str, Any]:
    """run.json's content: figures, then what is needed to repeat them."""
    report = {
        **_frames(outcome, scene),
        "scene": _scene_counts(scene.graph),
        **_cost(outcome),
        **_beside(outcome, scene.graph),
        **_origin(outcome),
        "warnings": [*outcome.told(), *outcome.slam.statistics()["warnings"]],
    }
    report["warnings"] += what_is_missing(report)
    return report


def _frames(outcome: RunOutcome, scene: Levelled) -> dict[str, Any]:
    statistics, tracked = outcome.slam.statistics(), len(scene.trajectory)
    return {
        "frames": outcome.frames,
        "tracked": tracked,
        "completion": tracked / outcome.frames if outcome.frames else 0.0,
        "skipped": dict(sorted({**outcome.source.skipped, **outcome.tally.skipped}.items())),
        "statuses": dict(sorted(outcome.tally.statuses.items())),
        "keyframes": len(scene.keyframes),
        "landmarks": len(scene.positions),
        "maps": statistics["maps"],
        "loops": statistics["loops"],
        "merges": statistics["merges"],
        "loop_candidates": statistics["loop_candidates"],
        "join_candidates": statistics["join_candidates"],
    }


def _cost(outcome: RunOutcome) -> dict[str, Any]:
    statistics = outcome.slam.statistics()
    return {
        "wall_s": outcome.wall_s,
        "waited_s": float(statistics["waited_s"]),
        "cpu_s": measures.cpu_s() - outcome.cpu_before_s,
        "fps": outcome.tally.seen / outcome.wall_s if outcome.wall_s > 0 else 0.0,
        "peak_memory_mb": measures.peak_memory_mb(),
        "startup_s": outcome.startup_s,
        "ended": datetime.now(UTC).isoformat(timespec="seconds"),
        "interrupted": outcome.tally.interrupted,
        "stages": statistics["stages"],
    }


def _beside(outcome: RunOutcome, graph: SceneGraph | None) -> dict[str, Any]:
    shown = outcome.view.report() if outcome.view else None
    segmented = outcome.segmentation.report() if outcome.segmentation else {}
    return {
        "segmentation": {"backend": outcome.segmenter, **segmented},
        **({"view": shown} if shown else {}),
        **marker_figures(outcome.markers, graph),
    }


def _origin(outcome: RunOutcome) -> dict[str, Any]:
    config = outcome.config
    return {
        "source": outcome.source.info,
        "versions": versions(core()),
        "commit": commit(core()),
        "configuration": {key: config.get(key) for key in config.keys()},  # noqa: SIM118
        "seed": config.get("system.seed"),
    }


def _scene_counts(graph: SceneGraph | None) -> dict[str, Any]:
    """How many of each kind of surface and structure, and in which frame all files are."""
    if graph is None:
        return {"frame": "first_camera"}
    figures = {"frame": "levelled" if graph.frame.levelled else "first_camera"}
    for kind in KINDS:
        figures |= kind.figures(graph)
    return figures
