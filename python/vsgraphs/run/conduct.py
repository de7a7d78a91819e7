"""A run from its request to its result, a step after the other."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vsgraphs.datasets import RecordedSequence, open_sequence
from vsgraphs.datasets.prefetch import Prefetcher
from vsgraphs.errors import InputError
from vsgraphs.export.atomic import prepare_directory
from vsgraphs.export.lock import Locks
from vsgraphs.run import measures
from vsgraphs.run.atlas_files import AtlasFiles
from vsgraphs.run.beside import Beside, segmenter_name
from vsgraphs.run.ending import attempt, end_work, leave_results
from vsgraphs.run.listener import Listener
from vsgraphs.run.outcome import RunOutcome
from vsgraphs.run.output import results_folder
from vsgraphs.run.pacing import AsFastAsPossible, Realtime
from vsgraphs.run.request import RunRequest
from vsgraphs.run.result_folder import ResultFolder
from vsgraphs.run.session import Session, Tally
from vsgraphs.run.settings import apply_assignments, apply_file, apply_shortcuts, apply_values
from vsgraphs.run.watching import RunView
from vsgraphs.run.writing import expected_files

if TYPE_CHECKING:
    from vsgraphs.run.result import Result

Guard = Callable[["Run"], AbstractContextManager[object]]


class Run:
    """One run; `go` it once. `stop`, `stopped` and `last_words` are for any thread.

    since_s: when it began, on the clock of time.monotonic, and cpu_before_s what the process had cost then:
    for a program that does nothing else, its start and 0.
    """

    def __init__(
        self,
        request: RunRequest,
        listener: Listener,
        *,
        since_s: float | None = None,
        cpu_before_s: float | None = None,
    ) -> None:
        self._request, self._listener = request, listener
        self._since_s = time.monotonic() if since_s is None else since_s
        self._cpu_before_s = measures.cpu_s() if cpu_before_s is None else cpu_before_s
        self._told_to_stop = threading.Event()
        self._to_stop: list[Callable[[], object]] = []
        self._folder: ResultFolder | None = None
        self.view: RunView | None = None

    def stop(self) -> None:
        """Has it end soon, with the results so far. Does not wait."""
        self._told_to_stop.set()
        for call in self._to_stop:
            call()

    def stopped(self) -> bool:
        """Whether it was told to stop."""
        if not self._told_to_stop.is_set():
            try:
                wanted = self._listener.failure is not None or self._request.stop()
            except Exception as error:  # as of any other callback
                self._listener.failure, wanted = error, True
            if wanted:
                self.stop()
        return self._told_to_stop.is_set()

    def last_words(self) -> str:
        """What is written and what is not, for a process that ends now."""
        return "nothing was written" if self._folder is None else self._folder.last_words()

    def go(self, guard: Guard = lambda _: contextlib.nullcontext()) -> Result:
        """Tracks all frames and writes all files; what failed on the way is the result's `failure`.

        guard: entered as long as there is something to keep, from the first frame to the last file. Raises
        InputError where it cannot begin, or where nothing can be written.
        """
        request = self._request
        named_by = request.source.path if isinstance(request.source, RecordedSequence) else request.source
        out = None if request.out is None else Path(request.out)
        warn = lambda line: self._listener.event(f"warning: {line}")  # noqa: E731
        with results_folder(out, Path(named_by)) as folder, Locks(warn) as locks:
            return self._go(folder, locks, guard)

    def _go(self, out: Path, locks: Locks, guard: Guard) -> Result:
        request, listener = self._request, self._listener
        source = request.source
        if not isinstance(source, RecordedSequence):
            source = open_sequence(source, request.camera)
        request.check()
        beside = Beside(request, source)
        prepare_directory(out)
        locks.hold_folder(out)
        request.check_schedule_out()
        atlas = AtlasFiles.of(request, out, locks, listener)
        self.view = RunView(request.showing, listener.event)
        _announce(source, listener)
        frames = source.frames[: request.max_frames]
        # The first images decode while the core is loaded.
        with Prefetcher(frames, limit_s=request.frame_timeout_s) as loaded:
            from vsgraphs.compiled import core

            config = make_config(core(), request)
            slam = atlas.start(core(), config, source.camera)
            names = expected_files(config.get("system.mode"), atlas.save_to)
            self._folder = ResultFolder(out, names, listener.event, locks.hold_folder)
            listener.begin(len(frames))
            with guard(self):
                self._at_stop(loaded.stop, slam.stop)
                outcome, failure = self._track(source, loaded, slam, config, beside, atlas)
                result = leave_results(outcome, self._folder, atlas, failure, locks, listener)
        result.failure = result.failure or listener.failure or self._vain(result, outcome.tally)
        return result

    def _track(
        self,
        source: RecordedSequence,
        loaded: Prefetcher,
        slam: Any,
        config: Any,
        beside: Beside,
        atlas: AtlasFiles,
    ) -> tuple[RunOutcome, Exception | None]:
        """All frames, and what they set off; what went wrong."""
        listener = self._listener
        pacing = Realtime(self.stopped) if config.get("system.realtime") else AsFastAsPossible()
        tracker = beside.attach(slam, config, listener.event)
        if self.view is not None:
            tracker = self.view.watch(tracker, slam, source.calibration, config.get("system.mode"))
        stamps = [frame.timestamp for frame in source.frames[: self._request.max_frames]]
        session = Session(tracker, loaded, stamps, listener, pacing, self.stopped)
        began = time.monotonic()
        with atlas.saved_meanwhile(slam, listener.event):
            failure = attempt(session.run)
        loaded.close()
        listener.doing("ending the work under way")
        failure = end_work(slam, beside, self.stopped, failure, listener.event)
        outcome = self._outcome(source, config, slam, session.tally, time.monotonic() - began)
        outcome.segmentation, outcome.view, outcome.warnings = beside.segmentation, self.view, atlas.warnings
        outcome.markers = beside.marker_outcome()
        return outcome, failure

    def _outcome(
        self, source: RecordedSequence, config: Any, slam: Any, tally: Tally, wall_s: float
    ) -> RunOutcome:
        whole = self._request.max_frames is None and not tally.interrupted
        first = tally.first_tracked_at
        return RunOutcome(
            source,
            config,
            slam,
            tally,
            frames=tally.seen + (sum(source.skipped.values()) if whole else 0),
            wall_s=wall_s,
            startup_s=None if first is None else first - self._since_s,
            cpu_before_s=self._cpu_before_s,
            segmenter=segmenter_name(self._request.segmenter),
            map_colours=self._request.map_colours,
        )

    def _at_stop(self, *calls: Callable[[], object]) -> None:
        self._to_stop += calls
        if self._told_to_stop.is_set():  # it was told before there was anybody to call
            self.stop()

    def _vain(self, result: Result, tally: Tally) -> InputError | None:
        if result.info.get("tracked", 1) or tally.interrupted:
            return None
        return InputError(nothing_tracked(self._request.source, tally))


def _announce(source: RecordedSequence, listener: Listener) -> None:
    """What was opened, and what had to be repaired."""
    listener.note(source.describe())
    for line in source.warnings:
        listener.event(f"warning: {line}")


def make_config(core: Any, request: RunRequest) -> Any:
    """The core's Config: defaults, then the file, then the options, then those with keywords of their own."""
    config = core.Config()
    if request.config is not None:
        apply_file(config, Path(request.config))
    if isinstance(request.options, Mapping):
        apply_values(config, request.options)
    else:
        apply_assignments(config, request.options)
    apply_shortcuts(config, request.shortcuts())
    return config


def nothing_tracked(source: Any, tally: Tally) -> str:
    """Why a run ended without a single pose, in one line."""
    unusable = tally.skipped["damaged"] + tally.skipped["stalled"] + tally.skipped["refused"]
    if tally.seen and unusable == tally.seen:
        first = tally.warnings[0].removeprefix("skipped: ") if tally.warnings else "unknown"
        return f"none of the {tally.seen} frames of {source} can be used; the first: {first}"
    return (
        f"no frame of {source} could be tracked ({tally.seen - unusable} of {tally.seen} readable): "
        "too little depth or texture to start a map; check the depth images and depth_scale"
    )
