"""Files that are no files, and texts that are made to hurt: one line that names the file, at once."""

from __future__ import annotations

import os
import re
import socket
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from conftest import Program, one_line_error
from fake_core import Config
from layouts import write_openloris, write_redwood

from vsgraphs.cli.compare import read_groundtruth
from vsgraphs.cli.show_run import describe_run
from vsgraphs.datasets import read_camera_file
from vsgraphs.datasets.lists import read_list
from vsgraphs.datasets.opencv_yaml import read_opencv_yaml
from vsgraphs.datasets.redwood import read_camera as read_redwood_camera
from vsgraphs.datasets.replica import read_truth as read_replica_truth
from vsgraphs.datasets.seven_scenes import open_folder as open_seven_scenes
from vsgraphs.errors import FrameError, InputError
from vsgraphs.evaluate.scene.truth import load_scene_truth
from vsgraphs.export.atomic import write_atomically
from vsgraphs.export.ply import read_ply
from vsgraphs.markers import load_markers
from vsgraphs.plans import load_plan
from vsgraphs.reading import parse_json, parse_yaml, read_text, shortened, shown
from vsgraphs.run.output import holds_a_trajectory
from vsgraphs.run.settings import apply_assignments, apply_file
from vsgraphs.scene_graph import load_scene_graph
from vsgraphs.segment.label_folder import _load as load_class_image
from vsgraphs.segment.onnx_model import OnnxSegmenter
from vsgraphs.segment.sidecar import read_sidecar
from vsgraphs.trajectory import read_tum_trajectory

Reader = Callable[[Path], Any]

YAML: dict[str, Reader] = {
    "configuration": lambda path: apply_file(Config(), path),
    "camera": read_camera_file,
    "opencv": read_opencv_yaml,
}
JSON: dict[str, Reader] = {
    "plan": lambda path: load_plan(path.rename(path.with_suffix(".json"))),
    "markers": load_markers,
    "scene graph": load_scene_graph,
    "scene truth": load_scene_truth,
    "sidecar": read_sidecar,
    "redwood": read_redwood_camera,
}
OTHERS: dict[str, Reader] = {
    "trajectory": read_tum_trajectory,
    "ground truth": read_groundtruth,
    "replica truth": read_replica_truth,
    "list": lambda path: read_list(path, 2),
    "points": read_ply,
    "model": lambda path: OnnxSegmenter(path, path),
    "class image": load_class_image,
}
READERS = {**YAML, **JSON, **OTHERS}


def refusal(reader: Reader, path: Path) -> str:
    with pytest.raises((InputError, FrameError)) as caught:
        reader(path)
    message = str(caught.value)
    assert "\n" not in message
    assert len(message) < 700, message
    return message


@pytest.fixture(params=["pipe", "device", "socket", "folder"])
def no_file(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Path]:
    path = tmp_path / "thing"
    if request.param == "pipe":
        os.mkfifo(path)
    elif request.param == "device":
        path.symlink_to("/dev/zero")
    elif request.param == "folder":
        path.mkdir()
    if request.param != "socket":
        yield path
        return
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(str(path))
        yield path


@pytest.mark.parametrize("name", READERS)
def test_what_is_no_regular_file_is_refused_and_not_waited_for(name: str, no_file: Path) -> None:
    if name == "ground truth" and no_file.is_dir():
        pytest.skip("the folder of a sequence")
    message = refusal(READERS[name], no_file)
    assert "thing" in message
    assert re.search(r"it is a (pipe|device|socket|folder)|no sequence|is empty", message), message


@pytest.mark.parametrize("name", [name for name in READERS if name not in ("points", "model", "class image")])
@pytest.mark.parametrize(
    "content", [b"", b"\0" * 5000, bytes(range(256)) * 20, b"\xff\xfea\0b\0", b"1 " * 500_000]
)
def test_empty_and_binary_files_and_one_long_line(name: str, content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "thing"
    path.write_bytes(content)
    if (name, content) in (("configuration", b""), ("list", b"")):
        return  # nothing in it, nothing wrong
    if name == "list" and content.startswith(b"1 "):
        return  # one row of many fields
    if name in ("trajectory", "ground truth", "replica truth") and content.startswith(b"1 "):
        READERS[name](path)
        return
    assert "thing" in refusal(READERS[name], path)


@pytest.mark.parametrize("name", [*YAML, *(set(JSON) - {"scene graph", "scene truth"})])
def test_a_file_far_too_large_is_not_read(name: str, tmp_path: Path) -> None:
    path = tmp_path / "thing"
    path.touch()
    os.truncate(path, 10**11)
    assert re.search(r"thing(\.json)? is larger than \d+ MB", refusal(READERS[name], path))


BOMB = "a: &a [x,x,x,x,x,x,x,x,x]\n" + "".join(
    f"{here}: &{here} [{','.join([f'*{before}'] * 9)}]\n"
    for before, here in zip("abcdefgh", "bcdefghi", strict=True)
)


@pytest.mark.parametrize("name", YAML)
@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("fx: " + "[" * 100_000, "nest"),
        ("- " * 100_000, "nest"),
        ("fx:\n" + "".join(" " * i + "a:\n" for i in range(1, 300)), "nested deeper than"),
        ("tracker: &a\n  x: *a\n", r":2: \*a stands within itself"),
        (BOMB + "fx: *i\n", "more than 20000 values"),
        ("- a\n" * 50_000, "more than 20000 values"),
        ("a: *b\n", r":1: no &b before \*b"),
        ("a: !!timestamp x\n", "tag !!timestamp is not read"),
        ("a: !!binary '###'\n", "tag !!binary is not read"),
        ("a: !!python/object/apply:os.system ['true']\n", "tag !!python/object/apply:os.system is not read"),
        ("a: !mine 5\n", "tag !mine is not read"),
        ("? [a]\n: 1\n", "cannot be a key"),
        ("a: 1\n--- \nb: 1\n", "a second document"),
        ("a: \x07\n", "not valid YAML"),
        ("a: [1, 2\n", "not valid YAML"),
    ],
)
def test_yaml_that_hurts(name: str, text: str, reason: str, tmp_path: Path) -> None:
    path = tmp_path / "thing.yaml"
    path.write_text(text)
    message = refusal(YAML[name], path)
    assert re.search(r"thing\.yaml:\d+: ", message), message
    assert re.search(reason, message), message


def test_yaml_without_surprises() -> None:
    text = "a: &x {k: 1, l: [1, 2.5, true, ~, 'no', 1e3]}\nb: {<<: *x, k: 2}\nc: 2001-99-99\nd: !!str 7\n"
    node = parse_yaml(text, "f")
    assert node is not None
    shared = [1, 2.5, True, None, "no", 1000.0]
    assert node.plain() == {
        "a": {"k": 1, "l": shared},
        "b": {"k": 2, "l": shared},
        "c": "2001-99-99",
        "d": "7",
    }
    large = parse_yaml(f"[{'9' * 30}, {'9' * 5000}, .inf, -.inf, {2**63 - 1}]", "f")
    assert large is not None
    assert large.plain() == [float("9" * 30), float("inf"), float("inf"), float("-inf"), 2**63 - 1]


@pytest.mark.parametrize("name", ["configuration", "camera"])
def test_a_key_twice_is_told(name: str, tmp_path: Path) -> None:
    path = tmp_path / "thing.yaml"
    path.write_text("fx: 1\nfy: 2\nfx: 3\n")
    assert "thing.yaml:3: 'fx' is there twice, first in line 1" in refusal(YAML[name], path)


def test_an_option_twice_in_two_ways_is_told(tmp_path: Path) -> None:
    path = tmp_path / "thing.yaml"
    path.write_text("tracker.max_features: 500\ntracker:\n  max_features: 600\n")
    assert ":3: 'tracker.max_features' is there twice, first in line 1" in refusal(
        YAML["configuration"], path
    )


def test_a_date_in_a_camera_file_is_a_word(tmp_path: Path) -> None:
    path = tmp_path / "camera.yaml"
    path.write_text("fx: 2001-99-99\nfy: 5\ncx: 1\ncy: 1\nwidth: 640\nheight: 480\n")
    assert "fx is '2001-99-99', expected a number" in refusal(read_camera_file, path)


@pytest.mark.parametrize("digits", [25, 400, 5000])
def test_numbers_no_machine_holds_are_out_of_range(digits: int, tmp_path: Path) -> None:
    number = "9" * digits
    for key in ("tracker.max_features", "tracker.huber_px"):
        with pytest.raises(InputError) as caught:
            apply_assignments(Config(), [f"{key}={number}"])
        assert len(str(caught.value)) < 300
        path = tmp_path / "thing.yaml"
        path.write_text(f"{key}: {number}\n")
        assert "thing.yaml:1: " in refusal(YAML["configuration"], path)


def test_a_file_called_by_a_number_keeps_its_name() -> None:
    config = Config()
    apply_assignments(config, ["system.mode=007"])
    assert config.get("system.mode") == "007"


@pytest.mark.parametrize("name", JSON)
@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("[" * 200_000, "nested too deeply"),
        ('{"a":' * 200_000, "nested too deeply"),
        ('{"a": [1,\n NaN]}', r":2: NaN is no number"),
        ('{"a": -Infinity}', "-Infinity is no number"),
        ('{"a": 1e999}', "1e999 is larger than any number"),
        (f'{{"a": {"9" * 5000}}}', "is larger than any whole number"),
        ('{"a": "\\ud800"}', "half a character"),
        ('{"a": 1', "not valid JSON"),
    ],
)
def test_json_that_hurts(name: str, text: str, reason: str, tmp_path: Path) -> None:
    path = tmp_path / "thing.json"
    path.write_text(text)
    message = refusal(JSON[name], path)
    assert "thing.json" in message
    assert re.search(reason, message), message


@pytest.mark.parametrize("name", ["plan", "markers", "sidecar"])
def test_a_key_twice_in_json_that_people_write(name: str, tmp_path: Path) -> None:
    path = tmp_path / "thing.json"
    path.write_text('{"a": 1,\n "b": 2, "a": 3}')
    assert '"a" is there twice' in refusal(JSON[name], path)


def test_truths_with_values_of_any_kind(tmp_path: Path) -> None:
    path = tmp_path / "scene_gt.json"
    for rooms in (
        "5",
        "[5]",
        '[{"id": 1}]',
        '[{"id": 1, "polygon": [], "z_floor": 0, "height": 1}]',
        '[{"id": {}}]',
    ):
        path.write_text(f'{{"rooms": {rooms}, "walls": []}}')
        assert "broken scene truth" in refusal(load_scene_truth, path)


def test_matrices_of_opencv_that_are_none(tmp_path: Path) -> None:
    folder = write_openloris(tmp_path / "cafe1-1")
    path = folder / "sensors.yaml"
    good = path.read_text()
    for old, new in (
        ("rows: 1", "rows: -1"),
        ("rows: 1", "rows: 1e999"),
        ("rows: 1", "row: 1"),
        ("data: [", "data: [x, "),
    ):
        path.write_text(good.replace(old, new))
        assert re.search(
            r"sensors\.yaml:\d+: not a matrix as OpenCV writes it", refusal(read_opencv_yaml, path)
        )


def test_a_camera_beside_the_images_that_cannot_be_read_is_told(tmp_path: Path) -> None:
    folder = write_redwood(tmp_path / "room")
    os.mkfifo(folder / "camera.yaml")
    from vsgraphs.datasets import open_sequence

    with pytest.raises(InputError, match=r"camera\.yaml: it is a pipe"):
        open_sequence(folder)


def test_poses_of_seven_scenes_that_are_pipes(tmp_path: Path) -> None:
    (tmp_path / "frame-000000.color.png").touch()
    (tmp_path / "frame-000000.depth.png").touch()
    (tmp_path / "frame-000000.pose.txt").touch()
    sequence = open_seven_scenes(tmp_path)
    (tmp_path / "frame-000000.pose.txt").unlink()
    os.mkfifo(tmp_path / "frame-000000.pose.txt")
    assert sequence.groundtruth is None or not len(sequence.groundtruth)


def test_names_with_anything_in_them_stay_one_line(tmp_path: Path) -> None:
    path = Path(os.fsdecode(os.fsencode(tmp_path) + b"/we\xffird\nname\x1b[31m" + b"x" * 200))
    message = refusal(lambda p: read_text(p, "file"), path)
    assert message.isprintable()


def test_what_is_shown_of_a_value() -> None:
    assert shown("wide") == "'wide'"
    assert shown([1, 2.5, None, True, {"a": [1]}, "x"]) == "[1, 2.5, null, true, ...]"
    assert shown({"a": {"b": {"c": 1}}}) == "{'a': {'b': {...}}}"
    assert len(shown("x" * 10**7)) < 70
    assert len(shown({"k" * 1000: ["v" * 1000] * 1000})) < 80
    assert "bits" in shown(10**5000)
    around: list[Any] = []
    around.append(around)
    assert len(shown(around)) < 40
    assert shortened("a\nb") == "a\\nb"
    assert shortened("0123456789" * 10, 25) == "0123456789012 ... 3456789"


def test_json_keeps_whole_numbers_of_64_bits() -> None:
    assert parse_json(f"[{2**63 - 1}, {-(2**63)}, 1e308]", "f") == [2**63 - 1, -(2**63), 1e308]


def test_devices_and_pipes_are_not_replaced_by_results(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", tmp_path, Path("/dev/null")):
        with pytest.raises(InputError, match="cannot write"):
            write_atomically(path, "x")
    assert (tmp_path / "pipe").is_fifo()
    (tmp_path / "loop").symlink_to("loop")
    with pytest.raises(InputError, match="lead in a circle"):
        write_atomically(tmp_path / "loop", "x")
    (tmp_path / "real").write_text("old")
    (tmp_path / "link").symlink_to("real")
    write_atomically(tmp_path / "link", "new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real").read_text() == "new"


def test_the_command_line_says_so_at_once(recorded: Path, tmp_path: Path, vsgraphs: Program) -> None:
    os.mkfifo(tmp_path / "pipe")
    bomb = tmp_path / "bomb.yaml"
    bomb.write_text(BOMB + "fx: *i\n")
    for option, value, word in (
        ("--config", tmp_path / "pipe", "it is a pipe"),
        ("--replay", tmp_path / "pipe", "it is a pipe"),
        ("--markers", "/dev/zero", "it is a device"),
        ("--camera", bomb, "more than 20000 values"),
        ("--set", "tracker.recovery.min_inliers=" + "9" * 400, "must be"),
    ):
        done = vsgraphs("run", recorded, "--out", tmp_path / "out", option, value, timeout=60)
        assert word in one_line_error(done)


@pytest.mark.parametrize("content", [None, b"[" * 100_000, b'{"frames": NaN}', b"\0" * 100])
def test_the_report_of_a_run_that_is_none(content: bytes | None, tmp_path: Path) -> None:
    (tmp_path / "trajectory.txt").write_text("1 0 0 0 0 0 0 1\n")
    if content is None:
        (tmp_path / "run.json").symlink_to("/dev/zero")
    else:
        (tmp_path / "run.json").write_bytes(content)
        assert "run.json" in refusal(describe_run, tmp_path)
    assert holds_a_trajectory(tmp_path)
