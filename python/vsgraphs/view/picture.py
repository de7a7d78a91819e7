"""What a run looks like: its newest frame, the newest map, the way so far."""

from __future__ import annotations

import time
from dataclasses import dataclass
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

REST = 3.0  # times the work
_SCENE_S = 1.0  # at least between two looks at the whole map


@dataclass(frozen=True)
class Shot:
    """A tracked frame; map_from_camera: (4, 4) pose, None while lost."""

    rgb: npt.NDArray[np.uint8]
    depth: npt.NDArray[np.generic]
    timestamp_s: float
    map_from_camera: Array | None


class Picture:
    """Draws what it is shown and what `slam` knows meanwhile. For one thread."""

    def __init__(self, slam: Any, camera: Calibration, sinks: Sinks, *, with_planes: bool) -> None:
        self._slam = slam
        self._sinks = sinks
        self._with_planes = with_planes
        self._camera = camera
        self._tail: list[tuple[float, Array]] = []
        self._map = MapView(np.zeros((0, 3)), np.zeros(0, np.int64), None, upright(SceneGraph()))
        self._map_from: Any = None
        self._next_scene_s = 0.0
        self._up_from_graph = np.eye(4)

    def begin(self) -> None:
        """What does not change."""
        self._sinks.arrange(layout())
        log_constants(self._sinks)
        self._frames = FrameLogger(self._sinks, self._camera)

    def show(self, shot: Shot) -> None:
        """A frame, and once a second the map."""
        self._sinks.at(shot.timestamp_s)
        now = time.monotonic()
        if now >= self._next_scene_s:
            self._refresh()
            self._next_scene_s = time.monotonic() + max(_SCENE_S, 4 * REST * (time.monotonic() - now))
        if shot.map_from_camera is not None:
            self._tail.append((shot.timestamp_s, shot.map_from_camera[:3, 3]))
        self._frames.log(shot.rgb, shot.depth, shot.map_from_camera, self._map)
        self._log_path(shot.timestamp_s)

    def show_result(self) -> None:
        """The finished map and the whole way."""
        self._map_from = None
        self._refresh()
        stamps, poses = self._slam.trajectory()
        if len(stamps):
            log_path(self._sinks, transform_points(self._map.up_from_map, poses[:, :3, 3]))
        if not self._sinks.window:  # a window's owner may have turned the view by hand
            self._sinks.arrange(layout(gaze_at(self._map.graph or SceneGraph(), self._up_from_graph)))

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
