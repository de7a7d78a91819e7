"""Mistakes in models, sidecars and `--segmenter`, each told in one line; and folders of class images."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from onnx import TensorProto
from PIL import Image
from tiny_models import colour_model, constant_model, write_sidecar

from vsgraphs.errors import FrameError, InputError
from vsgraphs.segment import RecordedSegmentations, Segmenter, SurfaceRole, make_segmenter, role_of_class
from vsgraphs.segment.label_folder import LabelFolder

INPUT = {"layout": "NCHW", "size": [8, 6]}
SCORES = {"kind": "semantic", "scores": "scores"}


def error_of(text: str) -> str:
    with pytest.raises(InputError) as caught:
        make_segmenter(text)
    message = str(caught.value)
    assert "\n" not in message
    return message


@pytest.fixture
def model(tmp_path: Path) -> Path:
    write_sidecar(tmp_path / "m.json")
    return colour_model(tmp_path / "m.onnx")


def test_geometry_is_no_segmenter() -> None:
    assert make_segmenter("geometry") is None


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("geometri", "did you mean 'geometry'?"),
        ("geometry:x", "expected geometry, onnx:FILE or labels:DIR"),
        ("onx:m.onnx", "did you mean 'onnx'?"),
        ("onnx", "expected onnx:FILE"),
        ("labels:", "expected labels:DIR"),
        ("onnx:nowhere.onnx", "nowhere.onnx is missing (VSGRAPHS_MODELS may name a folder"),
        ("onnx:m.onnx,thread=2", "unknown key 'thread'; did you mean 'threads'?"),
        ("onnx:m.onnx,2", "expected KEY=VALUE after a comma, not '2'"),
        ("onnx:m.onnx,threads=0", "threads must be 1 to 256"),
        ("onnx:m.onnx,provider=Abacus", "no provider 'Abacus'; it has "),
        ("onnx:m.onnx,sidecar=nowhere.json", "nowhere.json is missing"),
    ],
)
def test_mistakes_in_the_text(model: Path, monkeypatch: pytest.MonkeyPatch, text: str, says: str) -> None:
    monkeypatch.chdir(model.parent)
    monkeypatch.delenv("VSGRAPHS_MODELS", raising=False)
    assert says in error_of(text)


def test_models_are_looked_up_in_their_folder(model: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("VSGRAPHS_MODELS", str(model.parent))
    monkeypatch.chdir("/")
    assert make_segmenter("onnx:m.onnx") is not None
    assert "neither here nor in " + str(model.parent) in error_of("onnx:other.onnx")


def test_a_sidecar_may_lie_elsewhere(model: Path, tmp_path: Path) -> None:
    (tmp_path / "m.json").rename(tmp_path / "mine.json")
    assert f"the sidecar {tmp_path / 'm.json'} is missing" in error_of(f"onnx:{model}")
    assert make_segmenter(f"onnx:{model},sidecar={tmp_path / 'mine.json'},threads=2") is not None


def test_what_is_no_model(model: Path) -> None:
    model.write_bytes(b"not a model")
    assert f"model {model} is not an ONNX model this runtime can load" in error_of(f"onnx:{model}")
    model.unlink()
    assert f"model {model} is missing" in error_of(f"onnx:{model}")


def test_without_the_extra_its_name_is_said(model: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "onnxruntime", None)
    assert "pip install 'vsgraphs[onnx]'" in error_of(f"onnx:{model}")


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"inputs": {}}, "unknown key 'inputs'; did you mean 'input'?"),
        ({"input": {**INPUT, "sise": 1}}, "input: unknown key 'sise'; did you mean 'size'?"),
        ({"input": {"size": [8, 6]}}, "input: key 'layout' is missing"),
        ({"input": {**INPUT, "layout": "NHCW"}}, "'layout' cannot be 'NHCW'; did you mean 'N"),
        ({"input": {**INPUT, "size": [8]}}, "'size' must be a list of 2 numbers"),
        ({"input": {**INPUT, "size": [8, 0.5]}}, "'size' must be [width, height] in whole pixels"),
        ({"input": {**INPUT, "std": [1, 0, 1]}}, "'std' must be different from 0"),
        ({"input": {**INPUT, "mean": "x"}}, "'mean' must be a list of 3 numbers"),
        ({"input": {**INPUT, "name": "picture"}}, "input 'picture' is not of m.onnx, which has image"),
        ({"input": {**INPUT, "layout": "NHWC"}}, "that is not NHWC with 3 colours"),
        ({"input": None}, "key 'input' is missing"),
        ({"output": None}, "key 'output' is missing"),
        ({"output": {**SCORES, "kind": "sematic"}}, "'kind' cannot be 'sematic'; did you mean 'semantic'?"),
        ({"output": {**SCORES, "segments": "x"}}, "output (semantic): unknown key 'segments'"),
        ({"output": {"kind": "semantic"}}, "key 'scores' is missing"),
        (
            {"output": {**SCORES, "scores": "logits"}},
            "output 'logits' (scores) is not of the model, which has",
        ),
        ({"roles": None}, "key 'roles' is missing"),
        ({"roles": {}}, "no class has a role"),
        ({"roles": {"flor": "ground"}}, "unknown key 'flor'; did you mean 'floor'?"),
        ({"roles": {"floor": "grund"}}, "there is no role 'grund'; did you mean 'ground'?"),
        ({"roles": ["wall"]}, "roles: expected an object"),
        ({"classes": ["wall", "floor"]}, "2 classes are listed, but the network gives 3"),
        ({"classes": ["wall", "floor", "wall"]}, "'classes' lists 'wall' twice"),
        ({"classes": None, "roles": {"3": "wall"}}, "class 3 has a role, but the network gives 3 classes"),
        ({"classes": None, "roles": {"70000": "wall"}}, "class 70000 is beyond 65535"),
    ],
)
def test_mistakes_in_the_sidecar(model: Path, tmp_path: Path, changes: dict[str, Any], says: str) -> None:
    sidecar = write_sidecar(tmp_path / "m.json", **changes)
    colour_model(model, image=(1, 3, 6, 8))
    message = error_of(f"onnx:{model}")
    assert says in message
    assert str(sidecar) in message


def test_a_sidecar_that_is_no_json(model: Path, tmp_path: Path) -> None:
    sidecar = tmp_path / "m.json"
    sidecar.write_text('{"input": {},\n "output" 3}')
    assert f"{sidecar}:2: not valid JSON" in error_of(f"onnx:{model}")
    sidecar.write_text("[]")
    assert "expected a JSON object" in error_of(f"onnx:{model}")
    sidecar.write_bytes(b"\xff\xfe")
    assert "is not text" in error_of(f"onnx:{model}")


def test_a_sidecar_of_another_size(model: Path) -> None:
    colour_model(model, image=(1, 3, 12, 16))
    assert "input size 8x6, but m.onnx takes 16x12" in error_of(f"onnx:{model}")


def test_a_model_with_an_input_of_integers(model: Path) -> None:
    colour_model(model, dtype=TensorProto.INT64)
    assert "input 'image' is tensor(int64)" in error_of(f"onnx:{model}")


@pytest.mark.parametrize(
    ("outputs", "output", "says"),
    [
        ({"s": np.zeros((1, 3), np.float32)}, {"kind": "semantic", "scores": "s_out"}, "has shape (1, 3)"),
        ({"c": np.zeros((1, 2, 2), np.float32)}, {"kind": "semantic_argmax", "classes": "c_out"}, "integers"),
        ({"c": np.zeros((3, 2, 2), np.int64)}, {"kind": "semantic_argmax", "classes": "c_out"}, "shape (3,"),
        (
            {"c": np.full((1, 2), 3)},
            {"kind": "semantic_argmax", "classes": "c_out"},
            "class 3 is in the image",
        ),
        (
            {"c": np.full((1, 2), -1)},
            {"kind": "semantic_argmax", "classes": "c_out"},
            "class -1 in the image",
        ),
        (
            {"c": np.zeros((1, 5, 4), np.float32), "m": np.zeros((1, 6, 2, 2), np.float32)},
            {"kind": "panoptic_masks", "class_logits": "c_out", "mask_logits": "m_out"},
            "class_logits has 5 queries, mask_logits 6",
        ),
        (
            {"c": np.zeros((1, 5, 3), np.float32), "m": np.zeros((1, 5, 2, 2), np.float32)},
            {"kind": "panoptic_masks", "class_logits": "c_out", "mask_logits": "m_out"},
            "3 classes are listed, but the network gives 2",
        ),
        (
            {"s": np.ones((1, 2), np.int64), "k": np.zeros(1, np.int64), "p": np.ones(2, np.float32)},
            {
                "kind": "panoptic_segments",
                "segments": "s_out",
                "segment_classes": "k_out",
                "segment_scores": "p_out",
            },
            "1 segment classes, 1 ids, 2 scores",
        ),
    ],
)
def test_outputs_that_are_not_what_the_sidecar_says(
    tmp_path: Path, outputs: dict[str, np.ndarray], output: dict[str, Any], says: str
) -> None:
    model = constant_model(tmp_path / "m.onnx", outputs)
    sidecar = write_sidecar(tmp_path / "m.json", output=output)
    message = error_of(f"onnx:{model}")
    assert says in message
    assert str(sidecar) in message


def test_the_shipped_sidecar_is_one() -> None:
    from vsgraphs.segment.sidecar import read_sidecar

    sidecar = read_sidecar(Path(__file__).resolve().parent.parent / "examples" / "mosaic_r3.json")
    assert sidecar.input.size == (512, 512)
    expected = {
        1: "wall",
        4: "ground",
        29: "ground",
        6: "ceiling",
        9: "window",
        15: "door",
        20: "other",
        0: "undecided",
    }
    roles = sidecar.roles.roles(np.array(list(expected)))
    assert [SurfaceRole(role).name for role in roles] == list(expected.values())
    sidecar.roles.check_count(32)


# --- labels:DIR -----------------------------------------------------------------------------------------


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Two labelled frames; the second without instances."""
    for name, values in (("label/1.png", [[0, 1], [2, 7]]), ("label/2.png", [[1, 1], [1, 1]])):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        Image.fromarray(np.array(values, np.uint8)).save(tmp_path / name)
    (tmp_path / "instance").mkdir()
    Image.fromarray(np.array([[0, 300], [2, 9]], np.uint16)).save(tmp_path / "instance/1.png")
    (tmp_path / "labels.txt").write_text("# a comment\n2.0 label/2.png\n1.5 label/1.png instance/1.png\n")
    classes = {"void": 0, "wall": 1, "floor": 2, "lamp": 7}
    (tmp_path / "scene_gt.json").write_text(json.dumps({"plan": "x", "classes": classes}))
    return tmp_path


def test_label_images_are_found_by_time(folder: Path) -> None:
    labels = make_segmenter(f"labels:{folder}")
    assert isinstance(labels, RecordedSegmentations)
    first = labels.at(1.5002)
    assert first is not None
    assert first.roles.tolist() == [
        [SurfaceRole.undecided, SurfaceRole.wall],
        [SurfaceRole.ground, SurfaceRole.other],
    ]
    assert first.instances is not None
    assert first.instances.tolist() == [[0, 300], [2, 9]]
    second = labels.at(2.0)
    assert second is not None
    assert second.instances is None
    assert [labels.at(t) for t in (0.0, 1.498, 1.75, 3.0)] == [None] * 4


def test_a_callable_is_not_taken_for_recorded(model: Path) -> None:
    segmenter: Segmenter | RecordedSegmentations | None = make_segmenter(f"onnx:{model}")
    assert not isinstance(segmenter, RecordedSegmentations)


@pytest.mark.parametrize(
    ("name", "role"),
    [
        ("wall", "wall"),
        ("Floor", "ground"),
        ("floor; flooring", "ground"),
        ("windowpane, window", "window"),
        ("rug, carpet, carpeting", "ground"),
        ("wall-other-merged", "wall"),
        ("door-stuff", "door"),
        ("void", "undecided"),
        ("floor lamp", "other"),
        ("skirting, wall", "wall"),
        ("", "other"),
    ],
)
def test_roles_of_class_names(name: str, role: str) -> None:
    assert role_of_class(name) is SurfaceRole[role]


def test_own_classes_and_roles(folder: Path) -> None:
    classes = {"classes": {"a": 0, "b": 1, "c": 2, "d": 7}, "roles": {"b": "door", "c": "ceiling"}}
    (folder / "classes.json").write_text(json.dumps(classes))
    found = LabelFolder(folder).at(1.5)
    assert found is not None
    assert found.roles.tolist() == [
        [SurfaceRole.other, SurfaceRole.door],
        [SurfaceRole.ceiling, SurfaceRole.other],
    ]


@pytest.mark.parametrize(
    ("classes", "says"),
    [
        ({"classes": {}}, 'expected "classes"'),
        ({"classes": {"wall": -1}}, "class 'wall' must have a value from 0 to 65535"),
        ({"classes": {"lamp": 1}}, "no class is wall, ground, ceiling, door or window"),
        ({"classes": {"wall": 1}, "roles": {"wal": "wall"}}, "unknown key 'wal'; did you mean 'wall'?"),
        ({"classes": {"wall": 1}, "roles": {"wall": "wand"}}, "there is no role 'wand'"),
        ({"class": {"wall": 1}}, "unknown key 'class'; did you mean 'classes'?"),
    ],
)
def test_mistakes_in_the_class_list(folder: Path, classes: dict[str, Any], says: str) -> None:
    (folder / "classes.json").write_text(json.dumps(classes))
    message = error_of(f"labels:{folder}")
    assert says in message
    assert str(folder / "classes.json") in message


def test_folders_that_are_none(folder: Path) -> None:
    assert "is not a directory" in error_of(f"labels:{folder / 'nowhere'}")
    (folder / "scene_gt.json").unlink()
    assert "neither classes.json nor scene_gt.json" in error_of(f"labels:{folder}")
    (folder / "labels.txt").unlink()
    assert "labels.txt is missing" in error_of(f"labels:{folder}")


def test_a_damaged_label_image_concerns_its_frame(folder: Path) -> None:
    labels = LabelFolder(folder)
    Image.fromarray(np.full((2, 2), 3, np.uint8)).save(folder / "label/2.png")
    with pytest.raises(FrameError, match="class 3 is in the image, but not listed"):
        labels.at(2.0)
    Image.fromarray(np.zeros((2, 2, 3), np.uint8)).save(folder / "label/2.png")
    with pytest.raises(FrameError, match="a RGB image where one number per pixel"):
        labels.at(2.0)
    (folder / "label/2.png").write_bytes(b"")
    with pytest.raises(FrameError, match=r"2\.png is damaged"):
        labels.at(2.0)
    (folder / "label/2.png").unlink()
    with pytest.raises(FrameError, match=r"2\.png is missing"):
        labels.at(2.0)
    Image.fromarray(np.zeros((3, 2), np.uint16)).save(folder / "instance/1.png")
    with pytest.raises(FrameError, match=r"instance/1\.png: shape \(3, 2\)"):
        labels.at(1.5)


def test_what_the_simulator_writes_is_read(tmp_path: Path) -> None:
    from vsgraphs.simulate import Output, simulate

    out = tmp_path / "room"
    simulate("one_room", out, frames=2, output=Output(labels_every=1))
    stamp = float((out / "labels.txt").read_text().splitlines()[1].split()[0])
    found = LabelFolder(out).at(stamp)
    assert found is not None
    assert {SurfaceRole.wall, SurfaceRole.ground} <= {SurfaceRole(role) for role in np.unique(found.roles)}
    shutil.rmtree(out)


def test_the_command_line_says_it_in_one_line(recorded: Path, tmp_path: Path) -> None:
    command = [
        sys.executable,
        "-m",
        "vsgraphs",
        "run",
        recorded,
        "--out",
        tmp_path / "o",
        "--segmenter",
        "onx:m",
    ]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 2
    assert done.stderr.splitlines()[-1] == (
        "error: --segmenter onx:m: did you mean 'onnx'? expected geometry, onnx:FILE or labels:DIR"
    )
    assert not (tmp_path / "o").exists()
