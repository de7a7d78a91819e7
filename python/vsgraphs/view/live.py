"""Showing a run while it goes on, on a thread of its own.

The tracker hands each frame over and goes on at once: one frame waits, a newer one takes its place, and what
was not shown is counted. The thread rests after each piece of work for three times as long as that took: it
takes at most a quarter of one core from the run.
"""

from __future__ import annotations

import atexit
import sys
import threading
import time
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Any

from vsgraphs.datasets import Calibration
from vsgraphs.view.extra import rerun
from vsgraphs.view.picture import REST, Picture, Shot
from vsgraphs.view.sinks import Sinks

_LOOK_S = 0.02  # at least between two looks for a new frame
_END_S = 30.0  # what a run waits for its view at most
_HAND_OVER_S = 0.0005  # a thread that waits for the interpreter gets it this soon (Python's default is 5 ms)


class LiveView:
    """Shows what `offer` is given and what `slam` knows meanwhile; `close` shows the result.

    tell: for lines a person should see, from this object's thread. The images offered must not change later.
    """

    def __init__(
        self,
        slam: Any,
        camera: Calibration,
        sinks: Sinks,
        *,
        with_planes: bool,
        tell: Callable[[str], None],
    ) -> None:
        self._picture = Picture(slam, camera, sinks, with_planes=with_planes)
        self._sinks = sinks
        self._tell = tell
        # No lock and no signal: those would make the tracker wait for this thread now and then.
        self._waiting: deque[Shot] = deque(maxlen=1)
        self._closing = threading.Event()
        self._failed = False
        self.offered = self.shown = 0
        self.offer_s = 0.0
        self.warnings: list[str] = []
        self._hand_over_s = sys.getswitchinterval()
        sys.setswitchinterval(_HAND_OVER_S)
        self._thread = threading.Thread(target=self._work, name="view", daemon=True)
        self._ending = threading.Thread(target=self._end, name="view-end", daemon=True)
        self._thread.start()
        atexit.register(self._at_exit)

    def watch(self, tracker: Any) -> _Watched:
        """Something with the tracker's `track` that shows what it tracks."""
        return _Watched(tracker, self)

    def offer(self, rgb: Any, depth: Any, timestamp_s: float, result: Any) -> None:
        """Hands a tracked frame over, in microseconds. One that still waits is dropped and counted."""
        began = time.perf_counter()
        self.offered += 1
        if not self._failed:
            self._waiting.append(Shot(rgb, depth, timestamp_s, result.world_from_camera))
        self.offer_s += time.perf_counter() - began

    def close(self) -> None:
        """After the run: shows the finished map, waits until it has arrived; not for ever. Never raises."""
        if self._ending.ident is None:
            self._ending.start()
        self._ending.join(_END_S)
        sys.setswitchinterval(self._hand_over_s)
        atexit.unregister(self._at_exit)
        if self._ending.is_alive():
            self._fail("the viewer does not end, the run goes on without it")
            rerun().unregister_shutdown()  # which would wait for the same

    def report(self) -> dict[str, Any]:
        """For run.json."""
        mean = 1000 * self.offer_s / self.offered if self.offered else 0.0
        return {"shown": self.shown, "dropped": self.offered - self.shown, "mean_offer_ms": round(mean, 4)}

    def _work(self) -> None:
        self._guarded(self._picture.begin)
        while True:
            began = time.monotonic()
            if self._waiting:
                self._guarded(partial(self._show, self._waiting.pop()))
                self.shown += not self._failed
            rest = max(_LOOK_S, REST * (time.monotonic() - began))
            if self._failed or not self._sinks.streams or self._closing.wait(timeout=rest):
                return

    def _guarded(self, step: Callable[[], object]) -> None:
        """A viewer that fails costs a line, never the run."""
        try:
            step()
        except Exception as error:
            self._fail(f"the viewer failed, the run goes on without it: {type(error).__name__}: {error}")

    def _fail(self, line: str) -> None:
        if not self._failed:
            self.warnings.append(" ".join(line.split())[:300])
            self._tell(f"warning: {self.warnings[-1]}")
        self._failed = True

    def _halt(self) -> None:
        self._closing.set()
        self._sinks.hurry()
        self._thread.join(_END_S)

    def _at_exit(self) -> None:
        """A thread that is within Rerun when Python ends would abort the program."""
        self._halt()
        if self._ending.is_alive():
            self._ending.join(_END_S)

    def _end(self) -> None:
        self._halt()
        if self._thread.is_alive():
            return  # two at once would disturb each other
        if not self._failed and self._sinks.streams:
            self._guarded(self._picture.show_result)
        self._guarded(self._sinks.close)

    def _show(self, shot: Shot) -> None:
        self._picture.show(shot)


class _Watched:
    """A tracker that is watched."""

    def __init__(self, tracker: Any, view: LiveView) -> None:
        self._tracker = tracker
        self._view = view

    def track(self, rgb: Any, depth: Any, timestamp: float) -> Any:
        """As the tracker's; what it tracked is offered to the view."""
        result = self._tracker.track(rgb, depth, timestamp)
        self._view.offer(rgb, depth, timestamp, result)
        return result
