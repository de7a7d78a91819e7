"""Which cameras are refused, and that no published one is."""

from __future__ import annotations

from pathlib import Path

import pytest
from conftest import Program, one_line_error

import vsgraphs
from vsgraphs.datasets import CAMERAS, open_sequence, read_camera_file
from vsgraphs.errors import InputError


@pytest.mark.parametrize("name", CAMERAS)
def test_every_camera_built_in_can_be(name: str) -> None:
    assert CAMERAS[name].to_core().width == CAMERAS[name].width


def test_the_cameras_of_recorded_sequences_can_be(shared_data: Path) -> None:
    folders = [folder for folder in sorted(shared_data.iterdir()) if folder.is_dir()]
    assert folders
    for folder in folders:
        assert open_sequence(folder).camera.width > 0


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("fx: 1e300", "fx must be 27.9964 to 7329.2 px, not 1e.300"),
        ("fx: 4.5", "fx must be .*; give focal lengths in pixels"),
        ("cx: 1e9", "lies outside the image"),
        ("k1: 1e300", "distortion k1 must be"),
        ("distortion: [-9, 50, 3, 3, 1]", "folds the image over itself"),
        ("depth_scale: 1e300", "depth_scale must be 1 to 100000, not 1e.300"),
        ("depth_scale: 0.001", "depth_scale must be 1 to 100000, not 0.001"),
        ("depth_max: 1e300", "depth_max_m must be"),
        ("fps: 1e300", "fps must be"),
        ("width: 2147483647", "larger than any camera"),
        ("width: 99999999999999999999999", "larger than any camera"),
        ("width: 32", "width must be 64 to 8192 px, not 32"),
    ],
)
def test_a_file_s_camera_that_cannot_be(line: str, message: str, tmp_path: Path) -> None:
    values = {"width": "640", "height": "480", "fx": "525", "fy": "525", "cx": "319.5", "cy": "239.5"}
    key, _, value = line.partition(": ")
    values[key] = value
    if line == "width: 32":
        values["cx"] = "16"
    path = tmp_path / "camera.yaml"
    path.write_text("".join(f"{key}: {value}\n" for key, value in values.items()))
    with pytest.raises(InputError, match=message) as caught:
        read_camera_file(path)[0].to_core()
    assert "camera.yaml: " in str(caught.value)
    assert "\n" not in str(caught.value)


def test_the_command_line_names_the_file(recorded: Path, tmp_path: Path, vsgraphs: Program) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text((recorded / "camera.yaml").read_text() + "k1: -3\n")
    error = one_line_error(vsgraphs("run", recorded, "--out", tmp_path / "out", "--camera", path))
    assert "mine.yaml: camera: distortion (k1 k2 p1 p2 k3) -3 0 0 0 0 folds" in error


def test_fields_changed_later_are_checked_too() -> None:
    camera = vsgraphs.Camera(640, 480, 525.0, 525.0, 319.5, 239.5)
    camera.fx = 1e300
    with pytest.raises(InputError, match="fx must be"):
        vsgraphs.Slam(vsgraphs.Config(), camera)
    with pytest.raises(InputError, match="width must be 64 to 8192 px, not 2147483647"):
        vsgraphs.Camera(10**12, 480, 525.0, 525.0, 319.5, 239.5)
