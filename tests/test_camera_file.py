from __future__ import annotations

from pathlib import Path

import pytest

from vsgraphs.datasets import read_camera_file
from vsgraphs.errors import InputError

GOOD = "width: 640\nheight: 480\nfx: 525.0\nfy: 525.0\ncx: 319.5\ncy: 239.5\ndepth_scale: 5000\n"


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "camera.yaml"
    path.write_text(text)
    return path


def test_everything_read(tmp_path: Path) -> None:
    text = GOOD + (
        "distortion: [0.1, -0.2, 0.001, 0.002]\nfps: 10.0\ndepth_min: 0.35\ndepth_max: 6.0\n"
        "invalid_depth: [0, 65535, 7]\ndepth_noise: [0.001, 0.002, 0.4]\n"
        "depth_alignment_m: 0.01\nsource: somewhere\nlicence: CC\n"
        "rgb_depth_registered: false\nbaseline_for_bf: 0.075\nbf: 39.375\n"
    )
    camera, remarks = read_camera_file(written(tmp_path, text))
    assert camera.distortion == (0.1, -0.2, 0.001, 0.002, 0.0)
    assert (camera.fps, camera.depth_min_m, camera.depth_max_m) == (10.0, 0.35, 6.0)
    assert camera.invalid_depth == (0, 65535, 7)
    assert camera.depth_noise == (0.001, 0.002, 0.4)
    assert camera.depth_alignment_m == 0.01
    assert (camera.width, type(camera.width)) == (640, int)
    assert remarks == []


def test_defaults_are_told(tmp_path: Path) -> None:
    camera, remarks = read_camera_file(written(tmp_path, GOOD.replace("depth_scale: 5000\n", "")))
    assert camera.depth_scale == 5000.0
    assert "no depth_scale, 5000" in remarks[0]
    assert camera.distortion == (0.0,) * 5


def test_numbers_that_yaml_takes_for_words(tmp_path: Path) -> None:
    camera, _ = read_camera_file(written(tmp_path, GOOD.replace("5000", "5e3")))
    assert camera.depth_scale == 5000.0


def test_descriptive_keys_are_free_but_told(tmp_path: Path) -> None:
    _, remarks = read_camera_file(written(tmp_path, GOOD + "sensor_serial: A12\n"))
    assert remarks == ["camera.yaml: keys not used: sensor_serial"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (GOOD.replace("fx: 525.0\n", ""), "fx missing"),
        (GOOD + "distorsion: [1, 2, 3, 4]\n", "unknown key 'distorsion'; did you mean 'distortion'"),
        (GOOD + "depthscale: 1000\n", "unknown key 'depthscale'; did you mean 'depth_scale'"),
        (GOOD.replace("fx: 525.0", "fx: -525.0"), "fx is -525.0, must be positive"),
        (GOOD.replace("fy: 525.0", "fy: .nan"), "fy is nan, expected a finite number"),
        (GOOD.replace("fy: 525.0", "fy: wide"), "fy is 'wide', expected a number"),
        (GOOD.replace("width: 640", "width: 640.5"), "width is 640.5, expected whole pixels"),
        (GOOD.replace("cx: 319.5", "cx: 900"), "lies outside the image"),
        (GOOD.replace("5000", "0"), "depth_scale is 0.0, must be positive"),
        (GOOD + "depth_min: 5\ndepth_max: 2\n", "must be above 0 and below depth_max"),
        (GOOD + "distortion: [1, 2]\n", "distortion has 2 numbers, expected 4 or 5"),
        (GOOD + "distortion: 0.1\n", "distortion is 0.1, expected a list"),
        (GOOD + "distortion: [0, 0, 0, 0]\nk1: 0.1\n", "not both"),
        (GOOD + "invalid_depth: [70000]\n", "whole numbers from 0 to 65535"),
        (GOOD + "depth_noise: [1]\n", "depth_noise must be three numbers"),
        ("fx: [1, 2\n", r"camera.yaml:\d+: not valid YAML"),
        ("%YAML:1.0\n---\nCamera.fx: 5\n", "an OpenCV camera file"),
        ("just words\n", "expected YAML lines"),
        ("", "expected YAML lines"),
    ],
)
def test_mistakes_are_named(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        read_camera_file(written(tmp_path, text))
    assert "\n" not in str(caught.value)
    assert "camera.yaml" in str(caught.value)


def test_missing_and_binary_files(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot read camera file .*No such file"):
        read_camera_file(tmp_path / "none.yaml")
    path = tmp_path / "camera.yaml"
    path.write_bytes(b"\xff\xd8\xff\xe0" * 10)
    with pytest.raises(InputError, match="is not text"):
        read_camera_file(path)


def test_a_negative_focal_length_only_where_the_dataset_publishes_one(tmp_path: Path) -> None:
    path = written(tmp_path, GOOD.replace("fy: 525.0", "fy: -480.0"))
    with pytest.raises(InputError, match=r"fy is -480\.0, must be positive"):
        read_camera_file(path)
    assert read_camera_file(path, y_up=True)[0].fy == 480.0
