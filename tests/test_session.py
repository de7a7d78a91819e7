from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from fake_core import Slam
from layouts import write_tum

from vsgraphs.datasets import open_sequence
from vsgraphs.errors import FrameError
from vsgraphs.run.session import Session, Tally
from vsgraphs.sources import LoadedFrame
from vsgraphs.sources.pacing import Realtime
from vsgraphs.sources.prefetch import Prefetcher


class Lines:
    """A listener that remembers."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.states: list[str] = []

    def frame(self, tally: Tally, status: str) -> None:
        self.states.append(status)

    def event(self, line: str) -> None:
        self.lines.append(line)


def frames(count: int, damaged: tuple[int, ...] = (), fps: float = 10.0) -> Iterator[LoadedFrame]:
    rgb, depth = np.zeros((4, 4, 3), np.uint8), np.ones((4, 4), np.uint16)
    for i in range(count):
        following = (i + 1) / fps if i + 1 < count else None
        if i in damaged:
            error = FrameError(f"{i}.png is damaged: cut")
            yield LoadedFrame(i, i / fps, None, None, error, 0.0, 0.001, following)
        else:
            yield LoadedFrame(i, i / fps, rgb, depth, None, 0.0, 0.001, following)


def test_all_frames_are_tracked() -> None:
    slam, listener = Slam(), Lines()
    tally = Session(slam, frames(20), listener).run()
    assert (tally.seen, tally.tracked, slam.seen) == (20, 20, 20)
    assert not tally.skipped
    assert not tally.warnings
    assert not tally.interrupted
    assert tally.first_tracked_at is not None
    assert listener.states == ["ok"] * 20


def test_damaged_frames_are_skipped_counted_and_named() -> None:
    listener = Lines()
    tally = Session(Slam(), frames(20, damaged=(0, 3, 19)), listener).run()
    assert (tally.seen, tally.tracked, tally.skipped["damaged"]) == (20, 17, 3)
    assert listener.lines == [f"skipped: {i}.png is damaged: cut" for i in (0, 3, 19)]


def test_many_damaged_frames_do_not_flood() -> None:
    listener = Lines()
    tally = Session(Slam(), frames(200, damaged=tuple(range(100))), listener).run()
    assert (tally.tracked, tally.skipped["damaged"]) == (100, 100)
    assert len(listener.lines) == 6
    assert "counted but not named" in listener.lines[-1]


def test_a_frame_the_tracker_refuses_is_skipped() -> None:
    listener = Lines()
    tally = Session(Slam(["initialised", "refused"]), frames(5), listener).run()
    assert (tally.tracked, tally.skipped["refused"]) == (4, 1)
    assert "frame 1 at 0.100000 s: rgb: must be larger" in listener.lines[0]


def test_loss_and_return_are_told() -> None:
    listener = Lines()
    script = ["initialised", "ok", "coasting", "lost", "lost", "lost", "relocalised", "ok"]
    tally = Session(Slam(script), frames(10), listener).run()
    assert tally.tracked == 7
    assert listener.lines == [
        "lost at frame 3 (0.300 s)",
        "relocalised at frame 6 (0.600 s), lost for 0.30 s",
    ]
    assert tally.warnings == listener.lines


def test_stop_keeps_what_is_there() -> None:
    slam = Slam()
    tally = Session(slam, frames(50), Lines(), length=50, stop=lambda: slam.seen >= 7).run()
    assert tally.interrupted
    assert (tally.seen, tally.tracked) == (7, 7)


def test_an_error_of_ours_is_not_swallowed() -> None:
    class Broken(Slam):
        def track(self, *_: object) -> None:  # type: ignore[override]
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        Session(Broken(), frames(3), Lines()).run()


class Clock:
    """Time that passes only when somebody sleeps or works."""

    def __init__(self) -> None:
        self.now = 50.0

    def __call__(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds


class Working(Slam):
    """Takes its time over each frame."""

    def __init__(self, clock: Clock, costs: list[float]) -> None:
        super().__init__()
        self.clock, self.costs, self.at = clock, costs, []

    def track(self, rgb: np.ndarray, depth: np.ndarray, timestamp: float):  # type: ignore[no-untyped-def]
        self.at.append((timestamp, self.clock.now - 50.0))
        self.clock.now += self.costs[self.seen] if self.seen < len(self.costs) else 0.01
        return super().track(rgb, depth, timestamp)


def paced(costs: list[float], count: int = 12) -> tuple[Tally, Working]:
    clock = Clock()
    slam = Working(clock, costs)
    pacing = Realtime(lambda: False, clock, clock.sleep)
    return Session(slam, pacing.paced(frames(count)), Lines()).run(), slam


def test_realtime_gives_each_frame_at_its_time() -> None:
    tally, slam = paced([])
    assert (tally.tracked, tally.skipped["dropped"]) == (12, 0)
    for stamp, at in slam.at:
        assert at == pytest.approx(stamp, abs=1e-9)


def test_realtime_drops_what_a_camera_would() -> None:
    # Frame 2 (due 0.2) takes until 0.55: 3 and 4 are gone by then, 5 (due 0.5) is the newest.
    tally, slam = paced([0.01, 0.01, 0.35])
    assert [round(10 * stamp) for stamp, _ in slam.at] == [0, 1, 2, 5, 6, 7, 8, 9, 10, 11]
    assert tally.skipped["dropped"] == 2
    assert "2 frames came while an earlier one was tracked, dropped" in tally.warnings
    assert tally.seen == 12


def test_realtime_a_little_late_drops_nothing() -> None:
    tally, _ = paced([0.09] * 12)
    assert tally.skipped["dropped"] == 0
    assert tally.tracked == 12


def test_realtime_stops_within_a_gap_of_the_recording() -> None:
    clock = Clock()
    pacing = Realtime(lambda: clock.now > 51.0, clock, clock.sleep)
    assert pacing.admit(0.0, 3600.0)
    pacing.admit(3600.0, None)
    assert clock.now < 52.0


def test_with_a_folder_and_threads(tmp_path: Path) -> None:
    sequence = open_sequence(write_tum(tmp_path / "s"))
    sequence.frames[2].depth_path.unlink()
    with Prefetcher(sequence.frames) as loaded:
        tally = Session(Slam(), loaded, Lines()).run()
    assert (tally.tracked, tally.skipped["damaged"]) == (7, 1)
    assert len(tally.decode_spans) == 8
    assert all(duration > 0 for _, duration, _ in tally.decode_spans)
