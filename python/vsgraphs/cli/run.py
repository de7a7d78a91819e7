"""`vsgraphs run`: from a recorded sequence to a trajectory and a map."""

from __future__ import annotations

import os
import sys
import time
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vsgraphs.cli import measures
from vsgraphs.cli.atlas_files import AtlasFiles
from vsgraphs.cli.ending import attempt, end_work, leave_results
from vsgraphs.cli.interrupt import Interrupt
from vsgraphs.cli.pacing import AsFastAsPossible, Realtime
from vsgraphs.cli.progress import Progress
from vsgraphs.cli.result_folder import ResultFolder
from vsgraphs.cli.results import MarkerOutcome, RunOutcome, expected_files
from vsgraphs.cli.session import Session, Tally
from vsgraphs.cli.settings import Value, apply_assignments, apply_file, apply_shortcuts
from vsgraphs.cli.summary import summarise
from vsgraphs.cli.terminal import that_may_go
from vsgraphs.cli.viewing import RunView, Showing
from vsgraphs.datasets import RecordedSequence, open_sequence
from vsgraphs.datasets.prefetch import DEFAULT_LIMIT_S, Prefetcher
from vsgraphs.errors import InputError
from vsgraphs.export.atomic import prepare_directory
from vsgraphs.export.lock import Locks

if TYPE_CHECKING:
    from vsgraphs.markers import KeyframeMarkers, MarkerDetector, MarkerRegistry
    from vsgraphs.segment import KeyframeSegmentation, RecordedSegmentations, Segmenter

_INTERRUPTED = (
    "interrupted: results so far are kept and written; Ctrl-C again skips those still to be written"
)
MAP_COLOURS = ("image", "class")


@dataclass
class RunRequest:
    """What the user asked for."""

    source: Path
    out: Path
    camera: str | None = None
    max_frames: int | None = None
    segmenter: str = "geometry"
    map_colours: str = "image"
    markers: Path | None = None
    config_file: Path | None = None
    assignments: list[str] = field(default_factory=list)
    shortcuts: dict[str, Value] = field(default_factory=dict)
    showing: Showing = field(default_factory=Showing)
    save_atlas: Path | None = None
    load_atlas: Path | None = None
    autosave_s: float | None = None
    frame_timeout_s: float = DEFAULT_LIMIT_S
    overwrite: bool = False  # save_atlas may replace a file that the run does not start from
    keep: int = 1  # previous versions of save_atlas


def run_sequence(request: RunRequest) -> int:
    """Runs and writes the results; returns the exit code. Raises InputError for what the user can cure."""
    warn = lambda line: print(f"warning: {line}", file=sys.stderr, flush=True)  # noqa: E731
    with that_may_go(), Locks(warn) as locks:
        return _run_sequence(request, locks)


def _run_sequence(request: RunRequest, locks: Locks) -> int:
    sequence = open_sequence(request.source, request.camera)
    _check_map_colours(request)
    segmenter = _make_segmenter(request.segmenter)
    sought = _sought_markers(request.markers, sequence)
    _prepare_out(request, locks)
    atlas = AtlasFiles.of(request, locks)
    view = RunView(request.showing)
    frames = sequence.frames[: request.max_frames]
    _announce(sequence)
    # The first images decode while the core is loaded.
    with Prefetcher(frames, limit_s=request.frame_timeout_s) as loaded:
        from vsgraphs.compiled import core

        config = make_config(core(), request)
        slam = atlas.start(core(), config, sequence.camera)
        progress = Progress(len(frames))
        mode = config.get("system.mode")
        names = expected_files(mode, atlas.save_to)
        folder = ResultFolder(request.out, names, progress.event, locks.hold_folder)
        with Interrupt(folder.last_words) as interrupt:
            interrupt.at_first(loaded.stop, slam.stop, partial(progress.event, _INTERRUPTED))
            pacing = Realtime(interrupt.requested) if config.get("system.realtime") else AsFastAsPossible()
            markers = _markers_beside_tracking(slam, sought, config)
            segmentation = _beside_tracking(markers or slam, segmenter, config, progress)
            tracker = view.watch(
                segmentation or markers or slam, slam, sequence.calibration, mode, progress.event
            )
            stamps = [frame.timestamp for frame in frames]
            session = Session(tracker, loaded, stamps, progress, pacing, interrupt.requested)
            began = time.monotonic()
            with atlas.saved_meanwhile(slam, progress.event):
                failure = attempt(session.run)
            loaded.close()
            progress.doing("ending the work under way")
            failure = end_work(slam, segmentation, markers, interrupt, failure)
            outcome = _outcome(request, sequence, config, slam, session.tally, began)
            outcome.segmentation, outcome.view, outcome.warnings = segmentation, view, atlas.warnings
            outcome.markers = _marker_outcome(request, sought, markers)
            report, failure = leave_results(outcome, folder, atlas, failure, progress, locks)
    if report.get("tracked"):
        print(summarise(report, folder.folder), flush=True)
    _raise_where_in_vain(request, session.tally, report, failure)
    locks.release()  # all is written: the next run need not wait for somebody who only looks
    view.linger(folder.folder)
    return interrupt.exit_code


def _raise_where_in_vain(
    request: RunRequest, tally: Tally, report: dict[str, Any], failure: Exception | None
) -> None:
    if failure is not None:
        raise failure
    if not report["tracked"] and not tally.interrupted:
        raise InputError(nothing_tracked(request.source, tally))


def _check_map_colours(request: RunRequest) -> None:
    if request.map_colours not in MAP_COLOURS:
        raise InputError(f"--map-colours {request.map_colours}: must be one of {', '.join(MAP_COLOURS)}")


def _announce(sequence: RecordedSequence) -> None:
    """What was opened, and what had to be repaired."""
    print(sequence.describe(), flush=True)
    for line in sequence.warnings:
        print(f"warning: {line}", file=sys.stderr, flush=True)


def _prepare_out(request: RunRequest, locks: Locks) -> None:
    """Makes the folder, and keeps a second program from writing there."""
    prepare_directory(request.out)
    locks.hold_folder(request.out)
    _check_schedule_out(request)


def _check_schedule_out(request: RunRequest) -> None:
    """The core writes the schedule when all is done: better to know before that it cannot."""
    path = request.shortcuts.get("system.schedule_out")
    folder = Path(str(path)).parent
    if path is not None and not (folder.is_dir() and os.access(folder, os.W_OK)):
        raise InputError(f"--schedule-out {path}: {folder} is not a directory that can be written to")


def _make_segmenter(text: str) -> Segmenter | RecordedSegmentations | None:
    if text == "geometry":
        return None
    from vsgraphs.segment import make_segmenter

    return make_segmenter(text)


def _beside_tracking(
    slam: Any, segmenter: Segmenter | RecordedSegmentations | None, config: Any, progress: Progress
) -> KeyframeSegmentation | None:
    """Within the tracker's thread where every run must be alike, beside it otherwise."""
    if segmenter is None:
        return None
    from vsgraphs.segment import KeyframeSegmentation

    return KeyframeSegmentation(slam, segmenter, beside=not _repeatable(config), tell=progress.event)


@dataclass(frozen=True)
class _SoughtMarkers:
    registry: MarkerRegistry
    detector: MarkerDetector


def _sought_markers(path: Path | None, sequence: RecordedSequence) -> _SoughtMarkers | None:
    if path is None:
        return None
    from vsgraphs.markers import MarkerDetector, load_markers

    registry = load_markers(path)
    return _SoughtMarkers(registry, MarkerDetector(registry, sequence.camera))


def _markers_beside_tracking(slam: Any, sought: _SoughtMarkers | None, config: Any) -> KeyframeMarkers | None:
    if sought is None:
        return None
    from vsgraphs.markers import KeyframeMarkers

    return KeyframeMarkers(slam, sought.detector, beside=not _repeatable(config))


def _marker_outcome(
    request: RunRequest, sought: _SoughtMarkers | None, search: KeyframeMarkers | None
) -> MarkerOutcome | None:
    if sought is None or search is None:
        return None
    return MarkerOutcome(str(request.markers), sought.registry, search)


def _repeatable(config: Any) -> bool:
    return config.get("system.execution") == "serial" or bool(config.get("system.replay"))


def make_config(core: Any, request: RunRequest) -> Any:
    """The core's Config: defaults, then the file, then --set, then the options of their own."""
    config = core.Config()
    if request.config_file is not None:
        apply_file(config, request.config_file)
    apply_assignments(config, request.assignments)
    apply_shortcuts(config, request.shortcuts)
    return config


def nothing_tracked(source: Path, tally: Tally) -> str:
    """Why a run ended without a single pose, in one line."""
    unusable = tally.skipped["damaged"] + tally.skipped["stalled"] + tally.skipped["refused"]
    if tally.seen and unusable == tally.seen:
        first = tally.warnings[0].removeprefix("skipped: ") if tally.warnings else "unknown"
        return f"none of the {tally.seen} frames of {source} can be used; the first: {first}"
    return (
        f"no frame of {source} could be tracked ({tally.seen - unusable} of {tally.seen} readable): "
        "too little depth or texture to start a map; check the depth images and depth_scale"
    )


def _outcome(
    request: RunRequest, sequence: RecordedSequence, config: Any, slam: Any, tally: Tally, began: float
) -> RunOutcome:
    started = measures.process_start()
    first = tally.first_tracked_at
    whole = request.max_frames is None and not tally.interrupted
    return RunOutcome(
        sequence,
        config,
        slam,
        tally,
        frames=tally.seen + (sum(sequence.skipped.values()) if whole else 0),
        wall_s=time.monotonic() - began,
        startup_s=None if first is None else first - started,
        segmenter=request.segmenter,
        map_colours=request.map_colours,
    )
