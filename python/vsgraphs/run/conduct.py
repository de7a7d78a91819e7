"""A run from its request to its result, a step after the other."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vsgraphs.errors import InputError
from vsgraphs.export.lock import Locks
from vsgraphs.run import measures
from vsgraphs.run.beside import segmenter_name
from vsgraphs.run.ending import attempt, end_work, leave_results
from vsgraphs.run.events import Events
from vsgraphs.run.listener import Listener
from vsgraphs.run.opening import Opened, name_of_source, open_run
from vsgraphs.run.outcome import RunOutcome
from vsgraphs.run.output import results_folder
from vsgraphs.run.request import RunRequest
from vsgraphs.run.result_folder import ResultFolder
from vsgraphs.run.session import Session, Tally
from vsgraphs.run.settings import make_config
from vsgraphs.run.summary import nothing_tracked
from vsgraphs.run.watching import RunView
from vsgraphs.run.writing import expected_files
from vsgraphs.sources import Feed, camera_of
from vsgraphs.sources.pacing import Realtime

if TYPE_CHECKING:
    from vsgraphs.run.result import Result

Guard = Callable[["Run"], AbstractContextManager[object]]


class Run:
    """One run; `go` it once. `stop`, `stopped` and `last_words` are for any thread.

    since_s: when it began, on the clock of time.monotonic, and cpu_before_s what the process had cost then:
    for a program that does nothing else, its start and 0. view: where it is shown, once it is opened.
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
        request, listener = self._request, self._listener
        out = None if request.out is None else Path(request.out)
        warn = lambda line: listener.event(f"warning: {line}")  # noqa: E731
        with results_folder(out, name_of_source(request.source)) as folder, Locks(warn) as locks:
            opened = open_run(request, folder, locks, listener)
            self.view = opened.view
            return self._conduct(opened, locks, guard)

    def _conduct(self, opened: Opened, locks: Locks, guard: Guard) -> Result:
        listener, atlas = self._listener, opened.atlas
        # The first images decode while the core is loaded.
        with opened.feed(self.stopped) as feed:
            from vsgraphs.compiled import core

            config = make_config(core(), self._request, live=opened.facts.live)
            slam = atlas.start(core(), config, camera_of(opened.source))
            names = expected_files(config.get("system.mode"), atlas.save_to)
            self._folder = ResultFolder(opened.out, names, listener.event, locks.hold_folder)
            listener.begin(opened.length)
            with guard(self):
                self._at_stop(feed.stop, slam.stop)
                outcome, failure = self._track(opened, feed, slam, config)
                result = leave_results(outcome, self._folder, opened, failure, locks, listener)
        result.failure = result.failure or listener.failure or self._vain(result, outcome)
        return result

    def _track(
        self, opened: Opened, feed: Feed, slam: Any, config: Any
    ) -> tuple[RunOutcome, Exception | None]:
        """All frames, and what they set off; what went wrong."""
        listener, beside = self._listener, opened.beside
        tracker = beside.attach(slam, config, listener.event)
        camera = getattr(opened.source, "calibration", None) or opened.source.camera
        tracker = opened.view.watch(tracker, slam, camera, config.get("system.mode"))
        at_pace = bool(config.get("system.realtime")) and not opened.facts.live
        frames = Realtime(self.stopped).paced(feed) if at_pace else feed
        request = self._request
        events = Events(slam, request.on_keyframe, request.on_room, request.on_loop)
        session = Session(
            tracker, frames, listener, length=opened.length, stop=self.stopped, tracked=events.after
        )
        began = time.monotonic()
        with opened.atlas.saved_meanwhile(slam, listener.event):
            failure = attempt(session.run)
        feed.close()
        listener.doing("ending the work under way")
        failure = end_work(slam, beside, self.stopped, failure, listener.event)
        failure = failure or attempt(events.end)
        return self._outcome(opened, config, slam, session.tally, time.monotonic() - began), failure

    def _outcome(self, opened: Opened, config: Any, slam: Any, tally: Tally, wall_s: float) -> RunOutcome:
        request, first = self._request, tally.first_tracked_at
        whole = request.max_frames is None and request.every == 1 and not tally.interrupted
        return RunOutcome(
            opened.facts,
            config,
            slam,
            tally,
            frames=tally.seen + (sum(opened.facts.skipped.values()) if whole else 0),
            wall_s=wall_s,
            startup_s=None if first is None else first - self._since_s,
            cpu_before_s=self._cpu_before_s,
            segmenter=segmenter_name(request.segmenter),
            map_colours=request.map_colours,
            segmentation=opened.beside.segmentation,
            view=opened.view,
            markers=opened.beside.marker_outcome(),
            warnings=opened.atlas.warnings,
        )

    def _at_stop(self, *calls: Callable[[], object]) -> None:
        self._to_stop += calls
        if self._told_to_stop.is_set():  # it was told before there was anybody to call
            self.stop()

    def _vain(self, result: Result, outcome: RunOutcome) -> InputError | None:
        if result.info.get("tracked", 1) or outcome.tally.interrupted:
            return None
        source = self._request.source
        name = str(source) if isinstance(source, str | Path) else outcome.source.name
        return InputError(nothing_tracked(name, outcome.tally))
