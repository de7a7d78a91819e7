"""A segmenter's own classes, from what it says to what the map knows."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import fake_core
import numpy as np
import pytest
from layouts import Scene
from PIL import Image
from tiny_models import colour_model, constant_model, write_sidecar

import vsgraphs
from vsgraphs.errors import InputError, RunError
from vsgraphs.segment import KeyframeSegmentation, Segmentation, attach, make_segmenter
from vsgraphs.segment.classes import ClassTable
from vsgraphs.segment.label_folder import LabelFolder
from vsgraphs.segment.onnx_model import OnnxSegmenter
from vsgraphs.segment.segmentation import checked

ROLES = np.ones((2, 3), np.uint8)
CLASSES = np.array([[0, 1, 2], [2, 2, 0]], np.uint16)
# Two names of one number: FNV-1a, 32 bits.
COLLIDING = ("liquid", "costarring")


# --- what a segmenter may say ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("classes", "names", "says"),
    [
        (CLASSES, None, "classes and class_names go together"),
        (None, ["wall"], "classes and class_names go together"),
        (CLASSES.astype(np.int64), ["a", "b"], "classes must be uint16, not int64"),
        (CLASSES[:, :2], ["a", "b"], r"classes has shape \(2, 2\), roles \(2, 3\)"),
        (CLASSES, ["a"], "classes holds 2, beyond the 1 of class_names"),
        (CLASSES, [], "class_names is empty"),
        (CLASSES, "ab", "class_names must be a list of names"),
        (CLASSES, ["a", 2], "class_names: 2 is no name"),
        (CLASSES, ["a", "b", "a"], "class_names: the name 'a' is there twice"),
        (CLASSES, ["a", ""], "must be a text of 1 to 128 bytes"),
        (CLASSES, ["a", "ü" * 65], "must be a text of 1 to 128 bytes"),
        (CLASSES, ["a", "b\nc"], "without control characters"),
        (CLASSES, ["a", "\ud800"], "must be a text"),
        (CLASSES, [str(i) for i in range(65536)], "65536 names; at most 65535"),
    ],
)
def test_what_is_wrong_with_classes_is_said(classes: Any, names: Any, says: str) -> None:
    with pytest.raises(InputError, match="segmenter mine: .*" + says) as caught:
        checked(Segmentation(ROLES, None, None, classes, names), "mine")
    assert "\n" not in str(caught.value)


def test_classes_reach_the_core_as_they_are() -> None:
    def named(_: np.ndarray) -> Segmentation:
        return Segmentation(ROLES, classes=CLASSES, class_names=["table", "Tür"])

    slam = fake_core.Slam()
    with attach(slam, named, beside=False) as tracked:
        tracked.track(np.zeros((4, 4, 3), np.uint8), np.ones((4, 4), np.uint16), 0.0)
    ((classes, names),) = slam.classes
    np.testing.assert_array_equal(classes, CLASSES)
    assert names == ("table", "Tür")


def test_a_number_that_another_name_has_is_told_once_and_geometry_goes_on() -> None:
    class Refusing(fake_core.Slam):
        def add_segmentation(self, *_: Any) -> None:
            raise InputError("the class names 'liquid' and 'costarring' have one number")

    def named(_: np.ndarray) -> Segmentation:
        return Segmentation(ROLES, classes=CLASSES, class_names=COLLIDING)

    segmentation = KeyframeSegmentation(Refusing(), named, beside=False)
    for i in range(11):
        segmentation.track(np.zeros((4, 4, 3), np.uint8), np.ones((4, 4), np.uint16), i / 10)
    segmentation.finish()
    assert len(segmentation.warnings) == 1
    assert "geometry alone from here on: named: " in segmentation.warnings[0]
    assert "'liquid' and 'costarring'" in segmentation.warnings[0]
    report = segmentation.report()
    assert (report["segmented"], report["failed"]) == (0, 3)


# --- where segmenters have their names from --------------------------------------------------------------


def test_what_has_no_class_is_number_0() -> None:
    table = ClassTable({0: "void", 1: "wall", 4: "chair", 5: "Background"}, "here")
    assert table.names == ("wall", "chair")
    assert table.classes(np.array([[0, 1], [4, 5]])).tolist() == [[0, 1], [2, 0]]


def test_a_network_hands_on_the_names_of_its_sidecar(tmp_path: Path) -> None:
    rgb = np.zeros((6, 8, 3), np.uint8)
    rgb[:, :4, 0] = rgb[:, 4:, 2] = 255  # wall, and sofa: no role of its own
    found = OnnxSegmenter(colour_model(tmp_path / "m.onnx"), write_sidecar(tmp_path / "m.json"))(rgb)
    assert list(found.class_names or ()) == ["wall", "floor", "sofa"]
    assert found.classes is not None
    np.testing.assert_array_equal(found.classes, [[1] * 4 + [3] * 4] * 6)
    unnamed = write_sidecar(tmp_path / "m.json", classes=None, roles={"0": "wall"})
    found = OnnxSegmenter(tmp_path / "m.onnx", unnamed)(rgb)
    assert (found.classes, found.class_names) == (None, None)


def test_networks_of_segments_and_masks_do_too(tmp_path: Path) -> None:
    segments = {"s": np.array([[[0, 1], [2, 3]]], np.int32), "k": np.array([0, 2, 0], np.int64)}
    output = {"kind": "panoptic_segments", "segments": "s_out", "segment_classes": "k_out"}
    model = constant_model(tmp_path / "s.onnx", segments)
    found = OnnxSegmenter(model, write_sidecar(tmp_path / "s.json", output=output))(
        np.zeros((6, 8, 3), np.uint8)
    )
    assert found.classes is not None
    assert found.classes.tolist() == [[0, 1], [3, 1]]
    logits = np.full((1, 2, 4), -20, np.float32)
    logits[0, 0, 2] = logits[0, 1, 3] = 20  # a sofa, and void
    masks = np.full((1, 2, 2, 2), -20, np.float32)
    masks[0, :, 0] = 20
    output = {"kind": "panoptic_masks", "class_logits": "c_out", "mask_logits": "m_out"}
    model = constant_model(tmp_path / "m.onnx", {"c": logits, "m": masks})
    found = OnnxSegmenter(model, write_sidecar(tmp_path / "m.json", output=output))(
        np.zeros((6, 8, 3), np.uint8)
    )
    assert found.classes is not None
    assert found.classes.tolist() == [[3, 3], [0, 0]]


def test_class_names_of_a_sidecar_are_checked(tmp_path: Path) -> None:
    colour_model(tmp_path / "m.onnx")
    write_sidecar(tmp_path / "m.json", classes=["wall", "floor", "x" * 129])
    with pytest.raises(InputError, match=r"m\.json: classes: the name .* must be a text of 1 to 128 bytes"):
        make_segmenter(f"onnx:{tmp_path / 'm.onnx'}")


def label_folder(folder: Path, classes: dict[str, int]) -> Path:
    Image.fromarray(np.array([[0, 1], [2, 7]], np.uint8)).save(folder / "1.png")
    (folder / "labels.txt").write_text("1.5 1.png\n")
    (folder / "classes.json").write_text(json.dumps({"classes": classes}))
    return folder


def test_a_label_folder_hands_on_its_names(tmp_path: Path) -> None:
    found = LabelFolder(label_folder(tmp_path, {"void": 0, "lamp": 7, "wall": 1, "floor": 2})).at(1.5)
    assert found is not None
    assert list(found.class_names or ()) == ["wall", "floor", "lamp"]
    assert found.classes is not None
    assert found.classes.tolist() == [[0, 1], [2, 3]]
    assert checked(found, "labels").classes is not None


def test_class_names_of_a_label_folder_are_checked(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"classes\.json: classes: the name .* must be a text of 1 to 128"):
        LabelFolder(label_folder(tmp_path, {"void": 0, "wall": 1, "floor": 2, "x" * 129: 7}))


# --- what the map knows ----------------------------------------------------------------------------------


class Wall:
    """The camera slides before a wall of paint; the image's halves are called by the two names."""

    def __init__(self, *names: str) -> None:
        shifts = [8 * i for i in range(20)]
        self.scene = Scene(frames=20, width=320, height=240, focal_px=300.0, shifts_px=shifts)
        self.camera = vsgraphs.Camera(320, 240, 300.0, 300.0, 159.5, 119.5, fps=10.0, depth_scale=5000.0)
        self.names = names

    def segment(self, rgb: np.ndarray) -> Segmentation:
        roles = np.zeros((24, 32), np.uint8)
        if not self.names:
            return Segmentation(roles)
        classes = np.ones((24, 32), np.uint16)
        classes[:, 16:] = 2
        return Segmentation(roles, np.full((24, 32), 0.5, np.float32), classes, classes, self.names)

    def run(self, atlas: vsgraphs.AtlasState | None = None, **options: Any) -> vsgraphs.Slam:
        config = vsgraphs.Config()
        config.set("system.execution", "serial")
        for key, value in options.items():
            config.set(f"system.{key}", value)
        slam = vsgraphs.Slam(config, self.camera, atlas or vsgraphs.AtlasState())
        with attach(slam, self.segment, beside=False) as tracked:
            for i in range(self.scene.frames):
                tracked.track(self.scene.rgb(i), self.scene.depth(i), self.scene.stamp(i))
        slam.finish()
        return slam


def votes_in(snapshot: Any) -> dict[str, float]:
    (plane,) = snapshot.scene_graph()["planes"]
    votes: dict[str, float] = plane["class_votes"]
    return votes


def test_a_wall_has_votes_by_name_and_its_keyframes_the_classes_of_their_images() -> None:
    snapshot = Wall("wall", "picture").run().snapshot()
    keyframes = snapshot.keyframes()[0].tolist()
    assert snapshot.class_names == ["picture", "wall"]
    votes = votes_in(snapshot)
    assert votes.keys() == {"wall", "picture"}
    assert votes["wall"] == pytest.approx(votes["picture"], rel=0.1)
    assert sum(votes.values()) == pytest.approx(0.5 * len(keyframes), rel=0.02), "a vote per keyframe"
    seen = snapshot.keyframe_classes(keyframes[-1])
    assert seen["classes"].shape == seen["confidence"].shape == seen["instances"].shape == (30, 40)
    assert {seen["class_names"][k - 1] for k in np.unique(seen["classes"][:, :20])} == {"wall"}
    assert {seen["class_names"][k - 1] for k in np.unique(seen["classes"][:, 20:])} == {"picture"}
    np.testing.assert_allclose(seen["confidence"], 0.5, atol=1 / 255)
    assert np.unique(seen["instances"]).tolist() == [1, 2]
    assert snapshot.keyframe_classes(10**6) is None


def test_without_classes_there_are_none() -> None:
    snapshot = Wall().run().snapshot()
    assert snapshot.class_names == []
    assert votes_in(snapshot) == {}
    assert snapshot.keyframe_classes(int(snapshot.keyframes()[0][0])) is None


def test_an_atlas_holds_them_and_another_session_adds_to_them(tmp_path: Path) -> None:
    wall = Wall("wall", "picture")
    slam, config = wall.run(), vsgraphs.Config()
    vsgraphs.Atlas(slam.atlas_state(), config, wall.camera).save(tmp_path / "a.vsg")
    atlas = vsgraphs.load_atlas(tmp_path / "a.vsg")
    assert votes_in(atlas.snapshot()) == votes_in(slam.snapshot())
    assert atlas.snapshot().class_names == ["picture", "wall"]
    first = int(slam.snapshot().keyframes()[0][0])
    before, after = slam.snapshot().keyframe_classes(first), atlas.snapshot().keyframe_classes(first)
    np.testing.assert_array_equal(before["classes"], after["classes"])
    with pytest.raises(InputError, match="'liquid' and 'costarring' have one number"):
        slam.add_segmentation(0, ROLES, None, None, CLASSES, list(COLLIDING))


def test_a_replay_follows_the_labels(tmp_path: Path) -> None:
    schedule = str(tmp_path / "schedule.txt")
    told = Wall("wall", "picture").run(schedule_out=schedule)
    assert "labels " in Path(schedule).read_text()
    again = Wall("wall", "picture").run(replay=schedule)
    assert votes_in(again.snapshot()) == votes_in(told.snapshot())
    with pytest.raises(RunError, match="departs from the schedule"):
        Wall("wall", "poster").run(replay=schedule)


def test_what_the_core_is_not_given_right_is_said() -> None:
    slam = vsgraphs.Slam(vsgraphs.Config(), Wall().camera)
    with pytest.raises(InputError, match=r"classes: must be uint16 .*, not uint8"):
        slam.add_segmentation(0, ROLES, None, None, ROLES, ["a"])
    for names in ("ab", [1, 2], 5, ["\ud800"]):
        with pytest.raises(InputError, match="class_names: must be a list of texts, not "):
            slam.add_segmentation(0, ROLES, None, None, CLASSES, names)
    with pytest.raises(InputError, match="class 2 is beyond the 1 of class_names"):
        slam.add_segmentation(0, ROLES, None, None, np.full((2, 3), 2, np.uint16), ["a"])
