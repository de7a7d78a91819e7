"""Each kind of network output, from image to roles."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from onnx import TensorProto
from tiny_models import colour_model, constant_model, write_sidecar

from vsgraphs.errors import InputError
from vsgraphs.segment import Segmentation, SurfaceRole
from vsgraphs.segment.onnx_model import OnnxSegmenter, Runtime

WALL, GROUND, OTHER, UNDECIDED = (
    SurfaceRole.wall,
    SurfaceRole.ground,
    SurfaceRole.other,
    SurfaceRole.undecided,
)
IMAGE = np.zeros((6, 8, 3), np.uint8)
LARGE = 20.0  # a logit that is as good as certain


def segment(
    tmp_path: Path, outputs: dict[str, np.ndarray], output: dict[str, Any], **more: Any
) -> Segmentation:
    model = constant_model(tmp_path / "m.onnx", outputs)
    return OnnxSegmenter(model, write_sidecar(tmp_path / "m.json", output=output, **more))(IMAGE)


def colours() -> np.ndarray:
    """Left half red, right half green, one pixel blue."""
    rgb = IMAGE.copy()
    rgb[:, :4, 0] = rgb[:, 4:, 1] = 255
    rgb[0, 0] = (0, 0, 255)
    return rgb


EXPECTED = np.where(np.arange(8) < 4, WALL, GROUND) * np.ones((6, 1), np.uint8)
EXPECTED[0, 0] = OTHER


@pytest.mark.parametrize("dtype", [TensorProto.FLOAT, TensorProto.FLOAT16, TensorProto.UINT8])
def test_semantic_scores(tmp_path: Path, dtype: int) -> None:
    model = colour_model(tmp_path / "m.onnx", dtype=dtype)
    found = OnnxSegmenter(model, write_sidecar(tmp_path / "m.json"))(colours())
    np.testing.assert_array_equal(found.roles, EXPECTED)
    assert found.confidence is not None
    assert found.confidence.dtype == np.float32
    assert found.confidence.min() > 0.99
    assert found.instances is None


def test_layout_colour_order_and_normalisation(tmp_path: Path) -> None:
    # Channels last and blue first: class 0 (wall) is blue now. (v / 255 - mean) / std gives logits 2 and -1.
    settings = {"layout": "NHWC", "size": [8, 6], "colour": "bgr", "scale": 1 / 255, "mean": [1 / 3] * 3}
    model = colour_model(tmp_path / "m.onnx", image=(1, 6, 8, 3))
    sidecar = write_sidecar(
        tmp_path / "m.json",
        input={**settings, "std": [1 / 3] * 3},
        output={"kind": "semantic", "scores": "scores", "layout": "NHWC"},
    )
    found = OnnxSegmenter(model, sidecar)(colours())
    assert found.roles[0, 0] == WALL
    assert (found.roles[1:, 4:] == GROUND).all()
    assert (found.roles[1:, :4] == OTHER).all()
    assert found.confidence is not None
    np.testing.assert_allclose(found.confidence, np.exp(2) / (np.exp(2) + 2 * np.exp(-1)), atol=1e-5)


def test_mean_and_std_are_per_channel(tmp_path: Path) -> None:
    settings = {"layout": "NCHW", "size": [8, 6], "mean": [0, 10, 0], "std": [1, 5, 1]}
    sidecar = write_sidecar(tmp_path / "m.json", input=settings)
    rgb = np.full((6, 8, 3), 12, np.uint8)  # logits 12, (12 - 10) / 5, 12: class 1 is least likely
    confidence = OnnxSegmenter(colour_model(tmp_path / "m.onnx"), sidecar)(rgb).confidence
    np.testing.assert_allclose(confidence, 1 / (2 + np.exp(0.4 - 12)), rtol=1e-6)


def test_images_are_stretched_to_the_network_s_size(tmp_path: Path) -> None:
    model = colour_model(tmp_path / "m.onnx", image=(1, 3, 4, 2))
    sidecar = write_sidecar(tmp_path / "m.json", input={"layout": "NCHW"})  # the model says its size
    rgb = np.zeros((40, 60, 3), np.uint8)
    rgb[:20, :, 0] = rgb[20:, :, 1] = 255
    found = OnnxSegmenter(model, sidecar)(rgb)
    np.testing.assert_array_equal(found.roles, [[WALL] * 2] * 2 + [[GROUND] * 2] * 2)


def test_probabilities_are_taken_as_they_are(tmp_path: Path) -> None:
    scores = np.array([0.7, 0.2, 0.1], np.float32).reshape(1, 3, 1, 1)
    found = segment(
        tmp_path, {"s": scores}, {"kind": "semantic", "scores": "s_out", "values": "probabilities"}
    )
    assert found.confidence is not None
    assert found.confidence[0, 0] == pytest.approx(0.7)


@pytest.mark.parametrize("shape", [(2, 3), (1, 2, 3), (1, 1, 2, 3), (1, 2, 3, 1)])
def test_class_map(tmp_path: Path, shape: tuple[int, ...]) -> None:
    classes = np.array([0, 1, 2, 2, 1, 0], np.int64).reshape(shape)
    found = segment(tmp_path, {"c": classes}, {"kind": "semantic_argmax", "classes": "c_out"})
    np.testing.assert_array_equal(found.roles, [[WALL, GROUND, OTHER], [OTHER, GROUND, WALL]])
    assert found.confidence is None


def test_roles_by_number_without_a_class_list(tmp_path: Path) -> None:
    classes = np.array([[[1, 200, 255]]], np.uint8)
    roles = {"1": "door", "255": "undecided"}
    output = {"kind": "semantic_argmax", "classes": "c_out"}
    found = segment(tmp_path, {"c": classes}, output, classes=None, roles=roles)
    assert found.roles.tolist() == [[SurfaceRole.door, OTHER, UNDECIDED]]


def queries() -> dict[str, np.ndarray]:
    """Classes wall, floor, sofa and void; masks 2 x 4.

    0: wall on the left half, sure. 1: floor on the right half, sure. 2: sofa over the wall's top row but
    unsure of its class. 3: void everywhere. 4: a second wall, half of the right column, which the floor
    owns.
    """
    classes = np.full((5, 4), -LARGE, np.float32)
    for query, of in enumerate([0, 1, 2, 3, 0]):
        classes[query, of] = LARGE
    classes[2, 0] = LARGE  # 50 : 50 wall and sofa
    masks = np.full((5, 2, 4), -LARGE, np.float32)
    masks[0, :, :2] = masks[1, :, 2:] = LARGE
    masks[2, 0, :2] = masks[3] = LARGE
    masks[4, :, 3] = LARGE / 40
    return {"c": classes[None], "m": masks[None]}


MASKS = {"kind": "panoptic_masks", "class_logits": "c_out", "mask_logits": "m_out"}


def test_panoptic_masks(tmp_path: Path) -> None:
    found = segment(tmp_path, queries(), MASKS)
    np.testing.assert_array_equal(found.roles, [[WALL, WALL, GROUND, GROUND]] * 2)
    assert found.instances is not None
    assert len(np.unique(found.instances)) == 2
    assert found.instances.min() > 0
    assert found.confidence is not None
    assert found.confidence.min() > 0.99


def test_each_query_is_an_instance_and_its_doubt_is_kept(tmp_path: Path) -> None:
    tensors = queries()
    tensors["c"][0, 1] = tensors["c"][0, 0]  # both halves are wall now
    tensors["m"][0, 1, 0, 2] = np.log(0.75 / 0.25)
    found = segment(tmp_path, tensors, MASKS)
    assert (found.roles == WALL).all()
    assert found.instances is not None
    assert found.instances[0, 0] != found.instances[0, 3]
    assert found.confidence is not None
    assert found.confidence[0, 2] == pytest.approx(0.75, abs=1e-4)


def test_thresholds_of_panoptic_masks(tmp_path: Path) -> None:
    # The unsure sofa counts at 0.4, but where the sure wall is as likely, the wall stays: it comes first.
    tensors = queries()
    tensors["m"][0, 0, 0, :2] = -LARGE  # the wall leaves its top row to the sofa
    assert (segment(tmp_path, tensors, MASKS).roles[0, :2] == UNDECIDED).all()
    found = segment(tmp_path, tensors, {**MASKS, "score_threshold": 0.4})
    assert (found.roles[0, :2] != UNDECIDED).all()
    assert found.confidence is not None
    assert found.confidence[0, 0] == pytest.approx(0.5)
    # Without the floor's right column, the second wall is alone there; a floor that owns 3/4 of its mask is
    # kept at 0.7 and dropped at 0.8.
    tensors = queries()
    tensors["m"][0, 1, :, 2:] = np.log(0.55 / 0.45)
    tensors["m"][0, 4, 0, 3] = LARGE
    tensors["m"][0, 4, 1, 3] = -LARGE
    kept = segment(tmp_path, tensors, {**MASKS, "overlap_threshold": 0.7}).roles
    assert kept.tolist() == [[WALL, WALL, GROUND, WALL], [WALL, WALL, GROUND, GROUND]]
    dropped = segment(tmp_path, tensors, MASKS).roles
    assert dropped.tolist() == [[WALL, WALL, UNDECIDED, WALL], [WALL, WALL, UNDECIDED, UNDECIDED]]


def test_panoptic_masks_of_nothing(tmp_path: Path) -> None:
    tensors = queries()
    tensors["c"][:] = -LARGE
    tensors["c"][..., 3] = LARGE
    found = segment(tmp_path, tensors, MASKS)
    assert (found.roles == UNDECIDED).all()
    assert found.confidence is not None
    assert not found.confidence.any()


def test_void_may_be_another_class(tmp_path: Path) -> None:
    tensors = queries()
    tensors["c"] = np.roll(tensors["c"], 1, axis=2)  # void first
    names = {"classes": ["nothing", "wall", "floor", "sofa"]}
    found = segment(tmp_path, tensors, {**MASKS, "void_class": 0}, **names)
    np.testing.assert_array_equal(found.roles, [[WALL, WALL, GROUND, GROUND]] * 2)


SEGMENTS = {"kind": "panoptic_segments", "segments": "s_out", "segment_classes": "k_out"}


def test_panoptic_segments(tmp_path: Path) -> None:
    tensors = {
        "s": np.array([[[0, 1], [2, 3]]], np.int32),
        "k": np.array([0, 1, 0], np.int64),
        "p": np.array([0.9, 0.8, 0.7], np.float32),
    }
    found = segment(tmp_path, tensors, {**SEGMENTS, "segment_scores": "p_out"})
    assert found.roles.tolist() == [[UNDECIDED, WALL], [GROUND, WALL]]
    assert found.instances is not None
    assert found.instances.tolist() == [[0, 1], [2, 3]]
    np.testing.assert_allclose(found.confidence, [[0, 0.9], [0.8, 0.7]])


def test_panoptic_segments_with_numbers_of_their_own(tmp_path: Path) -> None:
    tensors = {
        "s": np.array([[7, 40], [0, 9]], np.int64),
        "k": np.array([1, 0], np.int64),
        "i": np.array([40, 7], np.int64),
    }
    output = {**SEGMENTS, "segment_ids": "i_out", "void_segment": 9}
    with pytest.raises(InputError, match="segment 0 in the image has no class"):
        segment(tmp_path, tensors, output)
    tensors["s"][1, 0] = 9
    found = segment(tmp_path, tensors, output)
    assert found.roles.tolist() == [[WALL, GROUND], [UNDECIDED, UNDECIDED]]


def test_threads_are_an_option(tmp_path: Path) -> None:
    model = colour_model(tmp_path / "m.onnx")
    segmenter = OnnxSegmenter(model, write_sidecar(tmp_path / "m.json"), Runtime(threads=2))
    options = segmenter._session.get_session_options()
    assert options.intra_op_num_threads == 2
    assert options.get_session_config_entry("session.intra_op.allow_spinning") == "0"
