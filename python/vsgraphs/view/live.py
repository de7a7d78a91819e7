"""Showing a run while it goes on, on a thread of its own.

The tracker hands each frame over and goes on at once: one frame waits, a newer one takes its place, and what
was not shown is counted. The thread rests after each piece of work for three times as long as that took: it
takes at most a quarter of one core from the run.
"""

from __future__ import annotations

import sys
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from vsgraphs.datasets import Calibration
from vsgraphs.export.class_colours import plane_of_points
from vsgraphs.scene_graph import SceneGraph, transform_points
from vsgraphs.trajectory import Array
from vsgraphs.view.frames import FrameLogger, MapView
from vsgraphs.view.layout import gaze_at, layout
from vsgraphs.view.scene import log_constants, log_landmarks, log_path, log_scene
from vsgraphs.view.sinks import Sinks
from vsgraphs.view.surfaces import upright

_REST = 3.0  # times the work
_LOOK_S = 0.02  # at least between two looks for a new frame
_SCENE_S = 1.0  # at least between two looks at the whole map
_HAND_OVER_S = 0.0005  # a thread that waits for the interpreter gets it this soon (Python's default is 5 ms)


@dataclass(frozen=True)
class _Shot:
    rgb: npt.NDArray[np.uint8]
    depth: npt.NDArray[np.generic]
    timestamp_s: float
    map_from_camera: Array | None


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
        self._slam = slam
        self._sinks = sinks
        self._with_planes = with_planes
        self._tell = tell
        self._camera = camera
        # No lock and no signal: those would make the tracker wait for this thread now and then.
        self._waiting: deque[_Shot] = deque(maxlen=1)
        self._closing = threading.Event()
        self._failed = False
        self._tail: list[tuple[float, Array]] = []
        self._map = MapView(np.zeros((0, 3)), np.zeros(0, np.int64), None, upright(SceneGraph()))
        self._map_from: Any = None
        self._next_scene_s = 0.0
        self._up_from_graph = np.eye(4)
        self.offered = self.shown = 0
        self.offer_s = 0.0
        self.warnings: list[str] = []
        self._hand_over_s = sys.getswitchinterval()
        sys.setswitchinterval(_HAND_OVER_S)
        self._thread = threading.Thread(target=self._work, name="view", daemon=True)
        self._thread.start()

    def watch(self, tracker: Any) -> _Watched:
        """Something with the tracker's `track` that shows what it tracks."""
        return _Watched(tracker, self)

    def offer(self, rgb: Any, depth: Any, timestamp_s: float, result: Any) -> None:
        """Hands a tracked frame over, in microseconds. One that still waits is dropped and counted."""
        began = time.perf_counter()
        self.offered += 1
        if not self._failed:
            self._waiting.append(_Shot(rgb, depth, timestamp_s, result.world_from_camera))
        self.offer_s += time.perf_counter() - began

    def close(self) -> None:
        """After the run: shows the finished map, waits until it has arrived. Never raises."""
        self._closing.set()
        self._thread.join()
        sys.setswitchinterval(self._hand_over_s)
        if not self._failed:
            self._guarded(self._show_result)
        self._guarded(self._sinks.close)

    def report(self) -> dict[str, Any]:
        """For run.json."""
        mean = 1000 * self.offer_s / self.offered if self.offered else 0.0
        return {"shown": self.shown, "dropped": self.offered - self.shown, "mean_offer_ms": round(mean, 4)}

    def _work(self) -> None:
        self._guarded(self._begin)
        while True:
            began = time.monotonic()
            if self._waiting:
                self._guarded(partial(self._show, self._waiting.pop()))
                self.shown += not self._failed
            rest = max(_LOOK_S, _REST * (time.monotonic() - began))
            if self._failed or self._closing.wait(timeout=rest):
                return

    def _guarded(self, step: Callable[[], object]) -> None:
        """A viewer that fails costs a line, never the run."""
        try:
            step()
        except Exception as error:
            if not self._failed:
                line = f"the viewer failed, the run goes on without it: {type(error).__name__}: {error}"
                self.warnings.append(" ".join(line.split())[:300])
                self._tell(f"warning: {self.warnings[-1]}")
            self._failed = True

    def _begin(self) -> None:
        self._sinks.arrange(layout())
        log_constants(self._sinks)
        self._frames = FrameLogger(self._sinks, self._camera)

    def _show(self, shot: _Shot) -> None:
        self._sinks.at(shot.timestamp_s)
        now = time.monotonic()
        if now >= self._next_scene_s:
            self._sinks.check_window()
            self._refresh()
            self._next_scene_s = time.monotonic() + max(_SCENE_S, 4 * _REST * (time.monotonic() - now))
        if shot.map_from_camera is not None:
            self._tail.append((shot.timestamp_s, shot.map_from_camera[:3, 3]))
        self._frames.log(shot.rgb, shot.depth, shot.map_from_camera, self._map)
        self._log_path(shot.timestamp_s)

    def _refresh(self) -> None:
        """Looks at the newest map: landmarks, planes, rooms."""
        snapshot = self._slam.snapshot()
        if self._map_from is not None and snapshot.version == self._map_from.version:
            return
        self._map_from = snapshot
        points, colours = snapshot.landmarks()
        graph, up_from_map = SceneGraph(), upright(SceneGraph())
        if self._with_planes:
            graph = SceneGraph.from_map(snapshot.scene_graph(), snapshot.keyframes())
            self._up_from_graph = upright(graph)
            up_from_map = self._up_from_graph @ graph.frame.world_from_map
            log_scene(self._sinks, graph, self._up_from_graph)
        owners = plane_of_points(graph, graph.points_from_map(points)) if self._with_planes else None
        self._map = MapView(
            points,
            np.full(len(points), -1) if owners is None else owners,
            graph if self._with_planes else None,
            up_from_map,
        )
        log_landmarks(self._sinks, transform_points(up_from_map, points), colours)

    def _log_path(self, until_s: float) -> None:
        """Keyframes as corrected, then the frames since the last one as they were tracked."""
        if self._map_from is None:
            return
        _, stamps, poses = self._map_from.keyframes()
        self._tail = [(s, p) for s, p in self._tail if (not len(stamps) or s > stamps[-1]) and s <= until_s]
        places = [*poses[:, :3, 3], *(p for _, p in self._tail)]
        log_path(self._sinks, transform_points(self._map.up_from_map, np.array(places).reshape(-1, 3)))

    def _show_result(self) -> None:
        self._map_from = None
        self._refresh()
        stamps, poses = self._slam.trajectory()
        if len(stamps):
            log_path(self._sinks, transform_points(self._map.up_from_map, poses[:, :3, 3]))
        if self._sinks.window is None:  # a window's owner may have turned the view by hand
            self._sinks.arrange(layout(gaze_at(self._map.graph or SceneGraph(), self._up_from_graph)))


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
