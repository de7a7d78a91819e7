"""The segmenter beside tracking, with a stand-in for the core."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import fake_core
import numpy as np
import pytest
from conftest import report
from fake_core import Slam
from tiny_models import colour_model, write_sidecar

from vsgraphs.cli.run import run_sequence
from vsgraphs.errors import FrameError, InputError
from vsgraphs.run import RunRequest
from vsgraphs.run.ending import drain
from vsgraphs.segment import KeyframeSegmentation, Segmentation, SurfaceRole, attach
from vsgraphs.segment.segmentation import checked

DEPTH = np.ones((4, 4), np.uint16)


def image(number: int) -> np.ndarray:
    return np.full((4, 4, 3), number, np.uint8)


def marked(rgb: np.ndarray) -> Segmentation:
    """Its confidence tells which image it was made of."""
    return Segmentation(np.ones((2, 2), np.uint8), np.full((2, 2), rgb[0, 0, 0] / 255, np.float32))


def handed_over(slam: Slam) -> list[tuple[int, int]]:
    """(frame, image) of each segmentation, in order of arrival."""
    return [(frame, round(float(confidence[0, 0]) * 255)) for frame, _, confidence, _ in slam.segmentations]


def track(segmentation: KeyframeSegmentation, first: int, last: int) -> None:
    for i in range(first, last):
        segmentation.track(image(i), DEPTH, i / 10)


class Gate:
    """A segmenter that waits until it is let go."""

    def __init__(self) -> None:
        self.entered, self.open = threading.Event(), threading.Event()

    def __call__(self, rgb: np.ndarray) -> Segmentation:
        self.entered.set()
        assert self.open.wait(30)
        return marked(rgb)


@pytest.fixture
def gate() -> Iterator[Gate]:
    gate = Gate()
    yield gate
    gate.open.set()


def test_within_track_each_keyframe_is_done_before_the_next_frame() -> None:
    slam = Slam()
    segmentation = KeyframeSegmentation(slam, marked, beside=False)
    for i in range(12):
        segmentation.track(image(i), DEPTH, i / 10)
        assert handed_over(slam) == [(k, k) for k in range(0, i + 1, 5)]
    segmentation.finish()
    counts = segmentation.report()
    assert counts.pop("median_ms") >= 0
    assert counts == {"segmented": 3, "dropped": 0, "failed": 0, "missing": 0}
    assert [frame for _, _, frame in segmentation.spans] == [0, 5, 10]
    assert not segmentation.warnings


def test_frames_the_tracker_refuses_are_not_counted() -> None:
    slam = Slam(["ok", "refused", "ok"])
    segmentation = KeyframeSegmentation(slam, marked, beside=False)
    for i in range(8):
        try:
            segmentation.track(image(i), DEPTH, i / 10)
        except ValueError:
            assert i == 1
    assert handed_over(slam) == [(0, 0), (5, 6)]


def test_frames_are_counted_on_in_a_loaded_atlas_as_the_core_does() -> None:
    slam = Slam()
    slam.first = 100
    segmentation = KeyframeSegmentation(slam, marked, beside=False)
    track(segmentation, 0, 6)
    assert handed_over(slam) == [(100, 0), (105, 5)], "not yesterday's keyframes of these numbers"


def test_beside_tracking_all_come_through_when_there_is_time() -> None:
    slam = Slam()
    with attach(slam, marked) as tracked:
        track(tracked, 0, 30)
    assert sorted(handed_over(slam)) == [(k, k) for k in range(0, 30, 5)]
    assert tracked.report()["segmented"] == 6
    assert tracked.waiting == 0


def test_a_slow_segmenter_gets_the_newest_and_loses_the_oldest(gate: Gate) -> None:
    slam, told = Slam(), list[str]()
    segmentation = KeyframeSegmentation(slam, gate, waiting=2, tell=told.append)
    track(segmentation, 0, 1)
    assert gate.entered.wait(30)  # keyframe 0 is under way, and tracking goes on
    track(segmentation, 1, 21)  # 5, 10, 15, 20 come meanwhile
    assert segmentation.waiting == 3
    gate.open.set()
    segmentation.finish()
    assert handed_over(slam) == [(0, 0), (20, 20), (15, 15)]
    assert segmentation.report()["dropped"] == 2
    assert (
        told == segmentation.warnings == ["segmentation: 2 keyframes dropped, Gate is slower than they come"]
    )


def test_the_end_waits_no_longer_than_it_says(gate: Gate) -> None:
    slam = Slam()
    segmentation = KeyframeSegmentation(slam, gate)
    track(segmentation, 0, 11)
    assert gate.entered.wait(30)
    segmentation.finish(0.01)
    assert segmentation.report()["dropped"] == 3
    assert any("did not come back from its last call" in line for line in segmentation.warnings)
    gate.open.set()
    for thread in threading.enumerate():
        if thread.name == "segmentation":
            thread.join(30)
    assert not slam.segmentations  # what comes too late is not handed over
    assert segmentation.report()["segmented"] == 0


def test_an_image_the_caller_uses_again_is_safe(gate: Gate) -> None:
    slam, buffer = Slam(), image(7)
    with KeyframeSegmentation(slam, gate) as segmentation:
        segmentation.track(buffer, DEPTH, 0.0)
        assert gate.entered.wait(30)
        for i in range(1, 6):
            segmentation.track(buffer, DEPTH, i / 10)
        buffer[:] = 99
        gate.open.set()
    assert handed_over(slam) == [(0, 7), (5, 7)]


def test_a_grey_image_is_segmented_as_rgb() -> None:
    shapes = list[tuple[int, ...]]()

    def note(rgb: np.ndarray) -> Segmentation:
        shapes.append(rgb.shape)
        return marked(rgb)

    slam = Slam()
    segmentation = KeyframeSegmentation(slam, note, beside=False)
    segmentation.track(image(7)[:, :, 0], DEPTH, 0.0)
    assert shapes == [(4, 4, 3)]
    assert handed_over(slam) == [(0, 7)]


@pytest.mark.parametrize("what", ["limit", "signal", "done"])
def test_the_program_stops_waiting_at_its_limit_or_a_signal(gate: Gate, what: str) -> None:
    slam = Slam()
    segmentation = KeyframeSegmentation(slam, gate)
    track(segmentation, 0, 11)
    assert gate.entered.wait(30)
    asked, told = list[int](), list[str]()

    def stop() -> bool:
        asked.append(1)
        if what == "done" or len(asked) > 2:
            gate.open.set()
        return what == "signal" and len(asked) > 2

    beside = SimpleNamespace(segmentation=segmentation, markers=None)
    drain(beside, 0.0 if what == "limit" else 60.0, stop, told.append)
    assert bool(told) == (what != "limit")
    counts = segmentation.report()
    if what == "limit":
        assert (counts["segmented"], counts["dropped"]) == (0, 3)
    elif what == "done":
        assert (counts["segmented"], counts["dropped"]) == (3, 0)
    else:
        assert counts["segmented"] + counts["dropped"] == 3
        assert len(asked) == 3


@pytest.mark.parametrize("beside", [False, True])
def test_a_segmenter_that_raises_is_told_once_and_left_alone(beside: bool) -> None:
    calls = list[int]()

    def broken(rgb: np.ndarray) -> Segmentation:
        calls.append(int(rgb[0, 0, 0]))
        if len(calls) == 2:
            raise RuntimeError("out of\nmemory")
        return marked(rgb)

    slam, told = Slam(), list[str]()
    segmentation = KeyframeSegmentation(slam, broken, beside=beside, tell=told.append)
    for i in range(20):
        segmentation.track(image(i), DEPTH, i / 10)
        while segmentation.waiting:
            pass
    segmentation.finish()
    assert calls == [0, 5]
    assert slam.seen == 20
    assert handed_over(slam) == [(0, 0)]
    assert told == ["segmentation failed, geometry alone from here on: broken: RuntimeError: out of memory"]
    counts = segmentation.report()
    assert (counts["segmented"], counts["failed"]) == (1, 3)


class Recorded:
    name = "recorded"

    def __init__(self, found: Callable[[float], Segmentation | None]) -> None:
        self.at = found


def test_recorded_segmentations_may_be_missing_or_damaged() -> None:
    def at(timestamp_s: float) -> Segmentation | None:
        if timestamp_s == 0.5:
            return None
        if timestamp_s == 1.0:
            raise FrameError("label/1.png is damaged: cut")
        return marked(image(round(10 * timestamp_s)))

    slam = Slam()
    segmentation = KeyframeSegmentation(slam, Recorded(at), beside=False)
    track(segmentation, 0, 16)
    segmentation.finish()
    assert handed_over(slam) == [(0, 0), (15, 15)]
    counts = segmentation.report()
    assert (counts["segmented"], counts["missing"], counts["failed"]) == (2, 1, 1)
    assert segmentation.warnings == ["segmentation: label/1.png is damaged: cut"]


@pytest.mark.parametrize("beside", [False, True])
def test_a_core_that_refuses_is_a_defect(beside: bool) -> None:
    class Refusing(Slam):
        def add_segmentation(self, *_: Any) -> None:
            raise fake_core.InputError("roles: no")

    segmentation = KeyframeSegmentation(Refusing(), marked, beside=beside)
    with pytest.raises(RuntimeError, match="refused the segmentation of frame 0: roles: no"):  # noqa: PT012
        segmentation.track(image(0), DEPTH, 0.0)
        segmentation.finish()


ROLES = np.ones((2, 3), np.uint8)


@pytest.mark.parametrize(
    ("result", "says"),
    [
        (ROLES, "expected a Segmentation, got ndarray"),
        (None, "expected a Segmentation, got NoneType"),
        (Segmentation(ROLES.tolist()), "roles must be a numpy array, not list"),
        (Segmentation(ROLES.astype(np.int64)), "roles must be uint8, not int64"),
        (Segmentation(ROLES[None]), r"roles must have shape \(h, w\), not \(1, 2, 3\)"),
        (Segmentation(ROLES[:0]), r"roles must have shape \(h, w\)"),
        (Segmentation(ROLES * 7), "roles holds 7, the largest SurfaceRole is 6"),
        (Segmentation(ROLES, np.ones((2, 3))), "confidence must be float32, not float64"),
        (Segmentation(ROLES, np.ones((3, 2), np.float32)), r"confidence has shape \(3, 2\), roles \(2, 3\)"),
        (Segmentation(ROLES, np.full((2, 3), 1.5, np.float32)), "confidence must be 0 to 1"),
        (Segmentation(ROLES, np.full((2, 3), np.nan, np.float32)), "confidence must be 0 to 1"),
        (Segmentation(ROLES, None, np.ones((2, 3), np.int32)), "instances must be uint16, not int32"),
        (Segmentation(ROLES, None, np.ones((2, 2), np.uint16)), r"instances has shape \(2, 2\), roles"),
    ],
)
def test_what_is_wrong_with_a_segmentation_is_said(result: Any, says: str) -> None:
    with pytest.raises(InputError, match="segmenter mine: " + says):
        checked(result, "mine")


def test_views_become_contiguous() -> None:
    good = checked(
        Segmentation(np.ones((4, 6), np.uint8)[::2, ::2], None, np.zeros((2, 3), np.uint16)), "mine"
    )
    assert good.roles.flags.c_contiguous
    assert good.roles.shape == (2, 3)


# --- vsgraphs run --segmenter ---------------------------------------------------------------------------


@pytest.fixture
def slams(monkeypatch: pytest.MonkeyPatch) -> list[Slam]:
    """The stand-ins that runs were made with."""
    made: list[Slam] = []

    def make(config: object, camera: object) -> Slam:
        made.append(Slam())
        return made[-1]

    core = SimpleNamespace(Config=fake_core.Config, Camera=lambda *_, **__: None, Slam=make)
    monkeypatch.setattr("vsgraphs.compiled.core", lambda: core)
    monkeypatch.setattr("vsgraphs.run.report.core", lambda: core)
    return made


@pytest.mark.parametrize("execution", ["serial", "threaded"])
def test_run_with_a_network(recorded: Path, tmp_path: Path, slams: list[Slam], execution: str) -> None:
    write_sidecar(tmp_path / "m.json", input={"layout": "NCHW", "size": [16, 12]})
    text = f"onnx:{colour_model(tmp_path / 'm.onnx')}"
    request = RunRequest(recorded, tmp_path, segmenter=text, execution=execution)
    assert run_sequence(request) == 0
    run = report(tmp_path)
    counts = run["segmentation"]
    assert counts["backend"] == text
    assert counts["segmented"] + counts["dropped"] == 12
    assert counts["failed"] == counts["missing"] == 0
    assert counts["median_ms"] > 0
    (slam,) = slams
    assert len(slam.segmentations) == counts["segmented"] > 0
    frames = [frame for frame, *_ in slam.segmentations]
    assert set(frames) <= set(range(0, 60, 5))
    if execution == "serial":
        assert frames == list(range(0, 60, 5))
    trace = json.loads((tmp_path / "timeline.json").read_text())["traceEvents"]
    assert sum(event["name"] == "segment" for event in trace) == counts["segmented"]
    assert "segmentation" in {event["args"].get("name") for event in trace}


def test_run_with_labels(recorded: Path, tmp_path: Path, slams: list[Slam]) -> None:
    from PIL import Image

    labels = tmp_path / "labels"
    labels.mkdir()
    Image.fromarray(np.full((4, 4), 1, np.uint8)).save(labels / "a.png")
    (labels / "labels.txt").write_text("100.500000 a.png\n101.000000 b.png\n")
    (labels / "classes.json").write_text('{"classes": {"wall": 1}}')
    request = RunRequest(recorded, tmp_path, segmenter=f"labels:{labels}", execution="serial")
    assert run_sequence(request) == 0
    run = report(tmp_path)
    del run["segmentation"]["median_ms"]
    counts = {"segmented": 1, "dropped": 0, "failed": 1, "missing": 10}
    assert run["segmentation"] == {"backend": f"labels:{labels}", **counts}
    assert [(frame, int(roles[0, 0])) for frame, roles, *_ in slams[0].segmentations] == [
        (5, SurfaceRole.wall)
    ]
    assert f"segmentation: {labels / 'b.png'} is missing" in run["warnings"]


def test_run_by_geometry(recorded: Path, tmp_path: Path, slams: list[Slam]) -> None:
    assert run_sequence(RunRequest(recorded, tmp_path)) == 0
    assert report(tmp_path)["segmentation"] == {"backend": "geometry"}
    assert not slams[0].segmentations
