"""What is told from Python while a run goes on: keyframes, rooms that were found, loops that were decided."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vsgraphs.scene_graph import RoomNode, SceneGraph

if TYPE_CHECKING:
    from vsgraphs.trajectory import Array

# Rooms are sought every 2 s; looking for new ones takes a millisecond.
_LOOK_S = 1.0
_CLOSED = ("joined", "closed")


@dataclass(frozen=True)
class KeyframeEvent:
    """A frame became a keyframe. index: the frame's. world_from_camera: (4, 4), as known then, metres; world
    is the first keyframe's camera.
    """

    index: int
    timestamp_s: float
    world_from_camera: Array


@dataclass(frozen=True)
class RoomEvent:
    """A room is in the map that was not before. graph: all that is known then, levelled as `room` is."""

    timestamp_s: float
    room: RoomNode
    graph: SceneGraph


@dataclass(frozen=True)
class LoopEvent:
    """Places that look alike were compared. closed: whether they were found to be one.

    verdict: as in run.json's `loop_candidates`. maps: whether two maps became one by it.
    """

    timestamp_s: float
    verdict: str
    closed: bool
    maps: bool


@dataclass
class Events:
    """Tells functions of what is new in a Slam, on the thread that tracks, between two frames."""

    slam: Any
    on_keyframe: Callable[[KeyframeEvent], object] | None = None
    on_room: Callable[[RoomEvent], object] | None = None
    on_loop: Callable[[LoopEvent], object] | None = None

    def __post_init__(self) -> None:
        self._rooms: set[int] = set()
        self._looked_at: float | None = None  # seconds of the sequence
        self._verdicts: dict[tuple[str, str], int] = {}
        self._last_s = 0.0
        if self.on_loop is not None:  # those of a loaded atlas are not new
            self._verdicts = self._counted()

    def after(self, result: Any, timestamp_s: float) -> None:
        """To be called with each frame's TrackResult."""
        self._last_s = timestamp_s
        if result.is_keyframe:
            if self.on_keyframe is not None and result.world_from_camera is not None:
                self.on_keyframe(KeyframeEvent(result.index, timestamp_s, result.world_from_camera))
            if self._looked_at is None or timestamp_s - self._looked_at >= _LOOK_S:
                self._looked_at = timestamp_s
                self._look_for_rooms()
        self._look_for_loops()

    def end(self) -> None:
        """To be called when all work has ended: what came of the last frames."""
        self._look_for_loops()
        self._look_for_rooms()

    def _look_for_rooms(self) -> None:
        if self.on_room is None:
            return
        snapshot = self.slam.snapshot()
        raw = snapshot.scene_graph()
        new = [int(row["id"]) for row in raw.get("rooms") or [] if int(row["id"]) not in self._rooms]
        if not new:
            return
        graph = SceneGraph.from_map(raw, snapshot.keyframes())
        for number in sorted(new):
            self._rooms.add(number)
            self.on_room(RoomEvent(self._last_s, graph.rooms[number], graph))

    def _look_for_loops(self) -> None:
        if self.on_loop is None:
            return
        counted = self._counted()
        for (kind, verdict), count in counted.items():
            for _ in range(count - self._verdicts.get((kind, verdict), 0)):
                self.on_loop(LoopEvent(self._last_s, verdict, verdict in _CLOSED, kind == "join"))
        self._verdicts = counted

    def _counted(self) -> dict[tuple[str, str], int]:
        statistics = self.slam.statistics()
        return {
            (kind, verdict): count
            for kind in ("loop", "join")
            for verdict, count in statistics[f"{kind}_candidates"]["verdicts"].items()
        }
