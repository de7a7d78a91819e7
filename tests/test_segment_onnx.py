"""Each kind of network output, from image to roles."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import pytest
from onnx import TensorProto, helper, numpy_helper
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


def refused(model: Path, sidecar: Path, **runtime: Any) -> str:
    with pytest.raises(InputError) as caught:
        OnnxSegmenter(model, sidecar, Runtime(**runtime))
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize(
    ("image", "message"),
    [
        ((1, 3, 0, 0), "takes images of 0x0 pixels; sides are 1 to 8192"),
        ((1, 3, 100_000, 100_000), "takes images of 100000x100000 pixels"),
        ((4, 3, 6, 8), "takes 4 images at once"),
        ((1, 5, 6, 8), "is not NCHW with 3 colours"),
        ((1, 3), "is not NCHW with 3 colours"),
    ],
)
def test_inputs_that_are_no_image(tmp_path: Path, image: tuple[int, ...], message: str) -> None:
    model = colour_model(tmp_path / "m.onnx", image=image)
    sidecar = write_sidecar(tmp_path / "m.json", input={"layout": "NCHW"})
    assert message in refused(model, sidecar)


def built(path: Path, nodes: list[Any], inputs: list[Any], outputs: list[Any], **more: Any) -> Path:
    graph = helper.make_graph(nodes, "odd", inputs, outputs, **more)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 13)])
    model.ir_version = 8
    onnx.save(model, path)
    return path


def picture(name: str) -> Any:
    return helper.make_tensor_value_info(name, TensorProto.FLOAT, (1, 3, 6, 8))


def test_a_model_without_inputs_or_outputs(tmp_path: Path) -> None:
    sidecar = write_sidecar(tmp_path / "m.json")
    weights = numpy_helper.from_array(np.zeros((1, 3, 6, 8), np.float32), "w")
    node = helper.make_node("Identity", ["w"], ["scores"])
    model = built(tmp_path / "m.onnx", [node], [], [picture("scores")], initializer=[weights])
    assert "takes no input" in refused(model, sidecar)
    model = built(tmp_path / "m.onnx", [], [picture("image")], [])
    assert re.search("not an ONNX model|gives no output", refused(model, sidecar))


def test_a_model_with_damaged_names(tmp_path: Path) -> None:
    model = colour_model(tmp_path / "m.onnx")
    content = model.read_bytes()
    assert content.count(b"image") >= 2
    model.write_bytes(content.replace(b"image", b"\xb9mage"))
    message = refused(model, write_sidecar(tmp_path / "m.json"))
    assert "a name in it is no text" in message or "is not an ONNX model" in message


def test_a_model_that_never_ends_is_stopped(tmp_path: Path) -> None:
    body = helper.make_graph(
        [helper.make_node("Identity", ["go"], ["goes"]), helper.make_node("Identity", ["a"], ["b"])],
        "body",
        [
            helper.make_tensor_value_info("i", TensorProto.INT64, ()),
            helper.make_tensor_value_info("go", TensorProto.BOOL, ()),
            picture("a"),
        ],
        [helper.make_tensor_value_info("goes", TensorProto.BOOL, ()), picture("b")],
    )
    endless = numpy_helper.from_array(np.array(2**62, np.int64), "n")
    yes = numpy_helper.from_array(np.array(True), "c")
    node = helper.make_node("Loop", ["n", "c", "image"], ["scores"], body=body)
    model = built(
        tmp_path / "m.onnx", [node], [picture("image")], [picture("scores")], initializer=[endless, yes]
    )
    message = refused(model, write_sidecar(tmp_path / "m.json"), limit_s=0.3)
    assert "m.onnx takes more than 0.3 s for an image, stopped" in message
    assert "limit=SECONDS" in message


def test_outputs_that_are_no_numbers(tmp_path: Path) -> None:
    sidecar = write_sidecar(tmp_path / "m.json")
    node = helper.make_node("SequenceConstruct", ["image"], ["scores"])
    kind = helper.make_tensor_sequence_value_info("scores", TensorProto.FLOAT, (1, 3, 6, 8))
    assert "is list, expected numbers" in refused(
        built(tmp_path / "m.onnx", [node], [picture("image")], [kind]), sidecar
    )
    texts = constant_model(tmp_path / "m.onnx", {"scores": np.full((1, 3, 6, 8), "x", object)})
    sidecar = write_sidecar(tmp_path / "m.json", output={"kind": "semantic", "scores": "scores_out"})
    assert "is object, expected numbers" in refused(texts, sidecar)
    not_numbers = constant_model(tmp_path / "m.onnx", {"scores": np.full((1, 3, 6, 8), np.nan, np.float32)})
    assert "confidence must be 0 to 1" in refused(not_numbers, sidecar)


def test_segments_beyond_any_number_need_no_memory(tmp_path: Path) -> None:
    outputs = {"seg": np.full((1, 6, 8), 2**60), "cls": np.array([0])}
    model = constant_model(tmp_path / "m.onnx", outputs)
    output = {"kind": "panoptic_segments", "segments": "seg_out", "segment_classes": "cls_out"}
    assert f"segment {2**60} in the image has no class" in refused(
        model, write_sidecar(tmp_path / "m.json", output=output)
    )
    sidecar = write_sidecar(tmp_path / "m.json", output={**output, "void_segment": 2**50})
    assert "'void_segment' must be an integer from 0 to 65535" in refused(model, sidecar)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"size": [10**9, 10**9]}, "[width, height] in whole pixels, 1 to 8192"),
        ({"size": [0, 6]}, "[width, height] in whole pixels, 1 to 8192"),
        ({"size": [8, 6], "std": [1e-300, 1, 1]}, "'std' must be different from 0, at least 1e-06"),
        ({"size": [8, 6], "scale": 1e300}, "'scale' must be at most 1e+06"),
        ({"size": [8, 6], "mean": [0, 0, -1e300]}, "'mean' must be at most 1e+06"),
    ],
)
def test_sidecar_numbers_that_no_image_has(tmp_path: Path, given: dict[str, Any], message: str) -> None:
    sidecar = write_sidecar(tmp_path / "m.json", input={"layout": "NCHW", **given})
    assert message in refused(colour_model(tmp_path / "m.onnx"), sidecar)
