"""Looking for markers beside a tracker, with a stand-in for both."""

from __future__ import annotations

import threading
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest

from vsgraphs.markers import Detections, KeyframeMarkers
from vsgraphs.trajectory import Array

RGB = np.zeros((4, 4, 3), np.uint8)
DEPTH = np.zeros((4, 4), np.uint16)


@dataclass
class Result:
    index: int
    is_keyframe: bool


@dataclass
class Tracker:
    """Every second frame is a keyframe."""

    frames: int = 0
    told: list[tuple[int, list[int]]] = field(default_factory=list)
    segmented: list[Any] = field(default_factory=list)

    def track(self, _rgb: Array, _depth: Array, _timestamp: float) -> Result:
        self.frames += 1
        return Result(self.frames - 1, (self.frames - 1) % 2 == 0)

    def add_markers(
        self, frame_index: int, ids: Array, size_m: Array, poses: Array, covariance: Array
    ) -> None:
        assert size_m.shape == ids.shape
        assert poses.shape == (len(ids), 4, 4)
        assert covariance.shape == (len(ids), 6, 6)
        self.told.append((frame_index, ids.tolist()))

    def add_segmentation(self, *arguments: Any) -> None:
        self.segmented.append(arguments)


def found(
    ids: list[int], unsure: tuple[int, ...] = (), scales: tuple[tuple[int, float], ...] = ()
) -> Detections:
    n = len(ids)
    poses, covariance = np.tile(np.eye(4), (n, 1, 1)), np.tile(np.eye(6), (n, 1, 1))
    return Detections(
        np.array(ids, np.int64), np.full(n, 0.16), poses, covariance, list(unsure), list(scales)
    )


@pytest.mark.parametrize("beside", [False, True])
def test_keyframes_are_searched_in_order(beside: bool) -> None:
    slam, seen = Tracker(), []

    def search(rgb: Array, depth: Array) -> Detections:
        seen.append((rgb.shape, depth.shape))
        return found([7, 9] if len(seen) != 2 else [])

    markers = KeyframeMarkers(slam, search, beside=beside)
    for i in range(5):
        markers.track(RGB, DEPTH, float(i))
    markers.add_segmentation(0, "roles")
    markers.finish()
    assert len(seen) == 3
    assert slam.told == [(0, [7, 9]), (4, [7, 9])]
    assert slam.segmented == [(0, "roles")]
    report = markers.report()
    assert (report["searched"], report["sights"], report["dropped"]) == (3, 4, 0)
    assert report["median_ms"] >= 0
    assert [frame for _, _, frame in markers.spans] == [0, 2, 4]


def test_a_slow_search_drops_the_oldest_and_says_so() -> None:
    slam, go = Tracker(), threading.Event()

    def search(_rgb: Array, _depth: Array) -> Detections:
        go.wait(10)
        return found([7])

    markers = KeyframeMarkers(slam, search, waiting=2)
    for i in range(20):
        markers.track(RGB, DEPTH, float(i))
    go.set()
    markers.finish()
    dropped = markers.report()["dropped"]
    assert dropped >= 7
    assert len(slam.told) == 10 - dropped
    assert slam.told[-1][0] == 18
    assert markers.warnings == [f"markers: {dropped} keyframes were not searched, they came too fast"]


@pytest.mark.parametrize("beside", [False, True])
def test_a_failing_search_is_told_on_the_callers_thread(beside: bool) -> None:
    def search(_rgb: Array, _depth: Array) -> Detections:
        raise ValueError("broken")

    markers = KeyframeMarkers(Tracker(), search, beside=beside)

    def go() -> None:
        markers.track(RGB, DEPTH, 0.0)
        markers.finish()

    with pytest.raises(RuntimeError, match="markers: broken"):
        go()


def test_a_size_that_depth_contradicts_is_told_once() -> None:
    answers = iter(
        [found([], scales=((7, 1.5),)), found([], scales=((7, 1.6), (9, 2.0))), found([9]), found([9])]
    )
    markers = KeyframeMarkers(Tracker(), lambda _rgb, _depth: next(answers), beside=False)
    for i in range(8):
        markers.track(RGB, DEPTH, float(i))
    markers.finish()
    assert markers.warnings == [
        "markers: by its depth marker 7 is 1.55 times as large as size_m says (2 sights left out); "
        "measure its black square"
    ]
