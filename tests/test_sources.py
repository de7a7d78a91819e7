"""Sources of frames that are no folders: what they must have, and how their frames come."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import fake_core
import numpy as np
import pytest
from conftest import report
from layouts import Scene, sliding_scene

import vsgraphs
from vsgraphs.datasets import open_sequence
from vsgraphs.errors import InputError
from vsgraphs.sources import Frame, ImageFrame, LoadedFrame, facts_of, feed_of
from vsgraphs.sources.feed import thinned, thinned_length
from vsgraphs.sources.newest import Newest
from vsgraphs.sources.prefetch import Prefetcher
from vsgraphs.trajectory import read_tum_trajectory

CAMERA = vsgraphs.Calibration(4, 3, 4.0, 4.0, 1.5, 1.0)


def image(index: int) -> ImageFrame:
    return ImageFrame(index / 10, np.zeros((3, 4, 3), np.uint8), np.ones((3, 4), np.uint16))


def images(count: int) -> list[Frame]:
    return [image(index) for index in range(count)]


class Recording:
    """The least that a source is."""

    camera = CAMERA

    def __init__(self, count: int) -> None:
        self.frames = images(count)


class Stream:
    """Nobody knows how long it is. closed: whether its generator was let go."""

    camera = CAMERA
    closed = False

    def __init__(self, frames: Iterable[Frame], *, live: bool = False) -> None:
        self._frames, self.live = frames, live

    @property
    def frames(self) -> Iterator[Frame]:
        try:
            yield from self._frames
        finally:
            self.closed = True


def test_what_is_left_out_has_a_default() -> None:
    facts = facts_of(Recording(3))
    assert (facts.name, facts.live, facts.length) == ("Recording", False, 3)
    assert facts.told == "Recording: 3 frames"
    assert facts.info == {"name": "Recording"}
    facts = facts_of(Stream([], live=True))
    assert (facts.live, facts.length, facts.told) == (True, None, "Stream, live")


def test_a_recorded_sequence_is_a_source(recorded: Path) -> None:
    sequence = open_sequence(recorded)
    facts = facts_of(sequence)
    assert (facts.name, facts.length, facts.live) == ("slide", 60, False)
    assert facts.told == sequence.describe()
    assert list(facts.info) == ["name", "path", "format", "camera"]


def test_what_is_no_source_is_told() -> None:
    with pytest.raises(InputError, match=r"^int is no source of frames: it has no `camera`"):
        facts_of(3)  # type: ignore[arg-type]
    source: Any = Recording(1)
    source.info = {"name": "mine", "lens": CAMERA}
    with pytest.raises(InputError, match="source mine: its info cannot be written as JSON"):
        facts_of(source)


@pytest.mark.parametrize(
    ("every", "most", "left"), [(1, None, 7), (3, None, 3), (3, 2, 2), (1, 5, 5), (1, 9, 7), (2, 4, 4)]
)
def test_thinning(every: int, most: int | None, left: int) -> None:
    source = Stream(images(7))
    kept = [round(10 * frame.timestamp) for frame in thinned(source.frames, every, most)]
    assert kept == list(range(0, 7, every))[:most]
    assert len(kept) == left == thinned_length(7, every, most)
    assert source.closed
    assert thinned_length(None, every, most) is None


def test_prefetching_an_iterator_of_unknown_length() -> None:
    source = Stream(images(9))
    with Prefetcher(source.frames, ahead=2, workers=3) as feed:
        frames = list(feed)
    assert [frame.index for frame in frames] == list(range(9))
    assert [frame.following for frame in frames] == [*(i / 10 for i in range(1, 9)), None]
    assert source.closed


def test_what_a_source_raises_comes_after_its_frames() -> None:
    def broken() -> Iterator[Frame]:
        yield from images(3)
        raise OSError("the cable is out")

    for feed in (Prefetcher(broken()), Newest(broken())):
        seen: list[LoadedFrame] = []
        with feed, pytest.raises(OSError, match="cable"):
            seen.extend(feed)
        assert [frame.index for frame in seen] == [0, 1, 2]


def test_a_source_that_makes_one_wait_is_waited_for_longer_than_a_disk() -> None:
    def slow() -> Iterator[Frame]:
        yield image(0)
        time.sleep(0.5)
        yield image(1)

    with Prefetcher(slow(), limit_s=0.1) as feed:
        assert [frame.error for frame in feed] == [None, None]


def test_leaving_early_lets_the_source_go() -> None:
    for live in (False, True):
        source = Stream((image(index) for index in range(10**6)), live=live)
        with feed_of(source, live=live) as feed:
            next(iter(feed))
        assert source.closed


def test_stopping_does_not_wait_for_a_camera() -> None:
    silent = threading.Event()

    def camera() -> Iterator[Frame]:
        yield image(0)
        silent.wait(30)

    feed = Newest(camera())
    threading.Timer(0.2, feed.stop).start()
    began = time.monotonic()
    assert [frame.index for frame in feed] == [0]
    feed.close()
    assert time.monotonic() - began < 5
    silent.set()


def test_of_a_camera_only_the_newest_frame_is_loaded() -> None:
    go_on, all_there = threading.Event(), threading.Event()

    def camera() -> Iterator[Frame]:
        yield image(0)
        go_on.wait(30)
        yield from images(5)[1:]
        all_there.set()

    seen = []
    with Newest(camera()) as feed:
        for frame in feed:
            seen.append((frame.index, frame.timestamp, frame.dropped, frame.rgb is not None))
            go_on.set()
            all_there.wait(30)
    assert seen[0] == (0, 0.0, False, True)
    assert seen[1:] == [(i, i / 10, True, False) for i in (1, 2, 3)] + [(4, 0.4, False, True)]


# --- runs


class Wall:
    """The scene of the tests, from memory."""

    def __init__(self, scene: Scene, *, live: bool = False, pace_s: float = 0.0) -> None:
        self.scene, self.live, self.pace_s = scene, live, pace_s
        self.length = None if live else scene.frames
        self.info = {"name": "wall", "made": "by a test"}
        self.warnings = ["it is painted"]

    @property
    def camera(self) -> Any:
        return open_camera(self.scene)

    @property
    def frames(self) -> Iterator[Frame]:
        for i in range(self.scene.frames):
            time.sleep(self.pace_s)
            rgb, depth = np.ascontiguousarray(self.scene.rgb(i)), self.scene.depth(i)
            yield ImageFrame(self.scene.stamp(i), rgb, depth)


def open_camera(scene: Scene) -> Any:
    middle = ((scene.width - 1) / 2, (scene.height - 1) / 2)
    focal = (scene.focal_px, scene.focal_px)
    return vsgraphs.Calibration(scene.width, scene.height, *focal, *middle, depth_scale=scene.depth_scale)


def test_a_source_of_one_s_own_runs(tmp_path: Path) -> None:
    said: list[str] = []
    scene = sliding_scene([2 * i for i in range(20)])
    source = Wall(scene)
    result = vsgraphs.run(source, tmp_path, every=2, on_message=lambda line: said.append(str(line)))
    run = report(tmp_path)
    assert (run["frames"], run["tracked"]) == (10, 10)
    assert run["source"] == {"name": "wall", "made": "by a test"}
    assert said[:2] == ["wall: 20 frames", "warning: it is painted"]
    assert "it is painted" in result.warnings
    assert len(read_tum_trajectory(tmp_path / "trajectory.txt")) == 10


def test_a_live_source_is_never_waited_for_and_ends_when_it_does(tmp_path: Path) -> None:
    source = Wall(sliding_scene([2 * i for i in range(30)]), live=True, pace_s=0.02)
    result = vsgraphs.run(source, tmp_path)
    assert result.info["configuration"]["system.realtime"] is True
    assert result.info["frames"] == 30
    assert not result.interrupted
    assert result.info["tracked"] + result.statuses.get("dropped", 0) == 30


def test_a_camera_that_gives_nothing_does_not_keep_a_run_from_ending(
    tmp_path: Path, fake: fake_core.Slam
) -> None:
    silent, told = threading.Event(), threading.Event()

    def camera() -> Iterator[Frame]:
        yield image(0)
        told.set()
        silent.wait(30)

    result = vsgraphs.run(Stream(camera(), live=True), tmp_path, stop=told.is_set)
    silent.set()
    assert result.interrupted


def test_a_live_source_runs_until_it_is_told_to_stop(tmp_path: Path, fake: fake_core.Slam) -> None:
    def endless() -> Iterator[Frame]:
        index = 0
        while True:
            time.sleep(0.002)
            yield image(index)
            index += 1

    source = Stream(endless(), live=True)
    result = vsgraphs.run(source, tmp_path, stop=lambda: fake.seen >= 10)
    assert result.interrupted
    assert result.info["tracked"] == 10
    assert source.closed


def test_labels_that_come_with_the_frames(tmp_path: Path, fake: fake_core.Slam) -> None:
    from vsgraphs.segment import Segmentation, SurfaceRole

    class Labels:
        def at(self, timestamp_s: float) -> Segmentation:
            return Segmentation(np.full((3, 4), SurfaceRole.wall, np.uint8))

    source: Any = Recording(11)
    with pytest.raises(InputError, match="Recording brings no segmentations"):
        vsgraphs.run(source, tmp_path, segmenter="source")
    source.streams = {"segmentations": Labels()}
    vsgraphs.run(source, tmp_path, segmenter="source", options={"system.execution": "serial"})
    assert [frame for frame, *_ in fake.segmentations] == [0, 5, 10]
