"""ScanNet, OpenLORIS-Scene, Redwood/Open3D: opened, told apart, and each kind of damage in one line."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from layouts import (
    Scene,
    opencv_transform,
    save,
    write_icl,
    write_openloris,
    write_redwood,
    write_replica,
    write_scannet,
    write_seven_scenes,
    write_tum,
)

from vsgraphs.cli.compare import read_groundtruth
from vsgraphs.datasets import FORMATS, open_sequence
from vsgraphs.errors import FrameError, InputError

WRITERS: dict[str, Callable[[Path], Path]] = {
    "TUM RGB-D": write_tum,
    "7-Scenes": write_seven_scenes,
    "Replica": write_replica,
    "ScanNet": write_scannet,
    "OpenLORIS-Scene": write_openloris,
    "Redwood/Open3D": write_redwood,
}


@pytest.mark.parametrize("name", WRITERS)
def test_each_format_is_detected_as_itself_alone(tmp_path: Path, name: str) -> None:
    folder = WRITERS[name](tmp_path / "seq")
    assert [reader.NAME for reader in FORMATS if reader.detect(folder)] == [name]
    assert open_sequence(folder).format == name


def test_what_people_add_to_a_folder_does_not_change_its_format(tmp_path: Path) -> None:
    loris = write_openloris(tmp_path / "cafe1-1")  # lists of pairs are often made beside the originals
    (loris / "associations.txt").write_text("1.0 color/1.png 1.0 aligned_depth/1.png\n")
    assert open_sequence(loris).format == "OpenLORIS-Scene"
    scannet = write_scannet(tmp_path / "scene0000_00")
    (scannet / "trajectory.log").write_text("0 0 1\n")
    assert open_sequence(scannet).format == "ScanNet"
    tum = write_tum(tmp_path / "desk")
    (tum / "trajectory.log").write_text("0 0 1\n")
    assert open_sequence(tum).format == "TUM RGB-D"
    icl = write_icl(tmp_path / "lr_kt2")
    (icl / "camera_intrinsic.json").write_text("{}")
    assert open_sequence(icl).format == "ICL-NUIM"


def test_images_alone_are_no_known_format(tmp_path: Path) -> None:
    folder = write_redwood(tmp_path / "seq")
    for name in ("camera_intrinsic.json", "trajectory.log"):
        (folder / name).unlink()
    with pytest.raises(InputError, match=r"no sequence in a known format.*camera_intrinsic\.json"):
        open_sequence(folder)


# --- ScanNet


def test_scannet(tmp_path: Path) -> None:
    scene = Scene(frames=4, depth_scale=1000.0)
    sequence = open_sequence(write_scannet(tmp_path / "scene0000_00"))
    calibration = sequence.calibration
    assert (calibration.width, calibration.height, calibration.fx) == (64, 48, 60.0)
    assert (calibration.depth_scale, calibration.cx) == (1000.0, 31.5)
    assert [frame.timestamp for frame in sequence.frames] == pytest.approx([0, 1 / 30, 2 / 30, 3 / 30])
    truth = sequence.groundtruth
    assert truth is not None
    np.testing.assert_allclose(truth.timestamps, [0, 1 / 30, 3 / 30])  # the lost pose is left out
    np.testing.assert_allclose(truth.poses[2], scene.pose(3), atol=1e-6)
    assert "1 of 4 poses are not rigid" in truth.notes[0]
    assert read_groundtruth(sequence.path).timestamps == pytest.approx(truth.timestamps)


def test_scannet_colour_is_brought_to_the_depth_images_pixels(tmp_path: Path) -> None:
    sequence = open_sequence(write_scannet(tmp_path / "scene"))
    ramp = np.tile((np.arange(128) * 2).astype(np.uint8)[None, :, None], (96, 1, 3))
    save(ramp, sequence.frames[1].rgb_path)
    rgb, depth = sequence.frames[1].load()
    assert rgb.shape == (48, 64, 3)
    assert depth[0, 0] == 2000
    u = np.arange(64)  # looks at column 2 u + 0.5 of the colour image: half a pixel more would be 2 in value
    np.testing.assert_allclose(rgb[:, 2:-2, 1].mean(axis=0), (2 * u + 0.5)[2:-2] * 2, atol=0.7)


def test_scannet_colour_moves_with_its_principal_point(tmp_path: Path) -> None:
    folder = write_scannet(tmp_path / "scene")
    still, _ = open_sequence(folder).frames[0].load()
    path = folder / "intrinsic/intrinsic_color.txt"
    rows = [line.split() for line in path.read_text().splitlines()]
    rows[0][2] = str(float(rows[0][2]) + 8)  # four pixels of the depth image
    path.write_text("\n".join(" ".join(row) for row in rows))
    moved, _ = open_sequence(folder).frames[0].load()
    np.testing.assert_allclose(moved[:, :-5].astype(int), still[:, 4:-1].astype(int), atol=2)
    np.testing.assert_array_equal(moved[:, -4:], np.repeat(moved[:, -5:-4], 4, axis=1))  # past the rim


def test_scannet_colour_of_the_depth_images_size_needs_no_camera_of_its_own(tmp_path: Path) -> None:
    folder = write_scannet(tmp_path / "scene", colour_scale=1)
    (folder / "intrinsic/intrinsic_color.txt").unlink()
    assert open_sequence(folder).frames[0].load()[0].shape == (48, 64, 3)


@pytest.mark.parametrize("image", ["depth", "color"])
def test_scannet_without_intrinsics(tmp_path: Path, image: str) -> None:
    folder = write_scannet(tmp_path / "scene")
    path = folder / f"intrinsic/intrinsic_{image}.txt"
    path.unlink()
    with pytest.raises(InputError, match=rf"intrinsic_{image}\.txt is missing.*--camera FILE"):
        open_sequence(folder)
    path.write_text("0 0 0 0\n" * 4)
    with pytest.raises(InputError, match=rf"intrinsic_{image}\.txt: fx, fy = 0, 0 must be positive"):
        open_sequence(folder)
    path.write_text("60 0 30\n0 60 20\n0 0 1\n")
    with pytest.raises(InputError, match=rf"intrinsic_{image}\.txt:1: 3 numbers where"):
        open_sequence(folder)


def test_scannet_poses_missing_or_lost(tmp_path: Path) -> None:
    folder = write_scannet(tmp_path / "scene")
    (folder / "pose/1.txt").unlink()
    sequence = open_sequence(folder)
    assert "pose/: 1 of 4 frames have no pose file" in sequence.warnings[-1]
    assert sequence.groundtruth is not None
    assert len(sequence.groundtruth) == 2
    (folder / "pose/0.txt").write_text("1 0 0 0\n0 1 0 0\n")
    with pytest.raises(InputError, match=r"0\.txt: 2 rows, expected a pose as a 4x4 matrix"):
        _ = open_sequence(folder).groundtruth
    for index in (0, 2, 3):
        (folder / f"pose/{index}.txt").write_text("-inf -inf -inf -inf\n" * 4)
    with pytest.raises(InputError, match=r"none of the 3 poses is a finite rigid transform"):
        _ = open_sequence(folder).groundtruth
    shutil.rmtree(folder / "pose")
    sequence = open_sequence(folder)
    assert sequence.groundtruth is None
    assert "no pose of any frame" in sequence.warnings[-1]


def test_scannet_counts_that_differ(tmp_path: Path) -> None:
    folder = write_scannet(tmp_path / "scene")
    (folder / "depth/3.png").unlink()
    sequence = open_sequence(folder)
    assert len(sequence.frames) == 3
    assert "color: 1 of 4 images have no partner in depth, left out" in sequence.warnings[0]
    for index in range(3):
        (folder / f"depth/{index}.png").rename(folder / f"depth/{index + 10}.png")
    with pytest.raises(InputError, match=r"\(from 0\).*\(from 10\) have no frame number in common"):
        open_sequence(folder)
    for path in (folder / "depth").iterdir():
        path.unlink()
    with pytest.raises(InputError, match=r"depth holds no images named by frame number"):
        open_sequence(folder)


def test_scannet_first_image_damaged(tmp_path: Path) -> None:
    folder = write_scannet(tmp_path / "scene")
    (folder / "color/0.jpg").write_bytes(b"no image")
    sequence = open_sequence(folder)
    with pytest.raises(FrameError, match=r"0\.jpg is damaged"):
        sequence.frames[0].load()
    assert sequence.frames[1].load()[0].shape == (48, 64, 3)
    for index in range(4):
        (folder / f"color/{index}.jpg").write_bytes(b"")
    with pytest.raises(InputError, match=r"none of the 4 images can be read; the first: .*0\.jpg"):
        open_sequence(folder)


# --- OpenLORIS-Scene


def test_openloris(tmp_path: Path) -> None:
    scene = Scene(frames=4)
    sequence = open_sequence(write_openloris(tmp_path / "cafe1-1"))
    calibration = sequence.calibration
    assert (calibration.fx, calibration.fy, calibration.cx, calibration.cy) == (60.0, 60.0, 31.5, 23.5)
    assert (calibration.depth_scale, calibration.fps, calibration.origin) == (1000.0, 30.0, "sensors.yaml")
    assert sequence.frames[0].depth_path.parent.name == "aligned_depth"
    assert sequence.frames[3].load()[1][0, 0] == 2000
    truth = sequence.groundtruth
    assert truth is not None
    np.testing.assert_allclose(truth.poses[3], scene.pose(3), atol=1e-7)  # the camera's, not the base's
    assert "moved from base_link" in truth.notes[0]


@pytest.mark.parametrize("which", ["", "groundtruth.txt"])
def test_openloris_truth_is_the_cameras_for_eval_too(tmp_path: Path, which: str) -> None:
    folder = write_openloris(tmp_path / "cafe1-1")
    truth = read_groundtruth(folder / which)
    np.testing.assert_allclose(truth.poses[3], Scene(frames=4).pose(3), atol=1e-7)


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (
            lambda f: (f / "aligned_depth.txt").unlink(),
            r"aligned_depth\.txt is missing: only depth registered",
        ),
        (lambda f: (f / "sensors.yaml").unlink(), r"sensors\.yaml is missing.*--camera FILE"),
        (lambda f: (f / "sensors.yaml").write_text("a: 1\n"), r"no sensor d400_color_optical_frame"),
        (lambda f: (f / "sensors.yaml").write_text("a: [1\n"), r"sensors\.yaml:2: not valid YAML"),
        (lambda f: (f / "sensors.yaml").write_text("words"), r"sensors\.yaml: expected the YAML"),
        (
            lambda f: _replace(f / "sensors.yaml", "width: 64", "width: wide"),
            r"width is 'wide', expected a number",
        ),
        (lambda f: _replace(f / "sensors.yaml", "cols: 4", "cols: 3"), r"not a matrix as OpenCV writes it"),
        (lambda f: _replace(f / "sensors.yaml", "60.0e", "-60.0e"), r"fx is -60\.0, must be positive"),
        (lambda f: (f / "color.txt").write_text("# none\n"), r"color\.txt lists no images"),
        (
            lambda f: _replace(f / "aligned_depth.txt", "156000488", "156000499"),
            r"within 0\.017 s of each other; the smallest gap is",
        ),
    ],
)
def test_openloris_damage(tmp_path: Path, damage: Callable[[Path], object], message: str) -> None:
    folder = write_openloris(tmp_path / "cafe1-1")
    damage(folder)
    with pytest.raises(InputError, match=message) as caught:
        open_sequence(folder)
    assert "\n" not in str(caught.value)


def _replace(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def test_openloris_truth_without_its_chain_of_frames(tmp_path: Path) -> None:
    folder = write_openloris(tmp_path / "cafe1-1")
    path = folder / "trans_matrix.yaml"
    _replace(path, "parent_frame: base_link", "parent_frame: laser")
    with pytest.raises(InputError, match=r"no chain of frames from d400.* to base_link \(ends at laser\)"):
        _ = open_sequence(folder).groundtruth
    loop = opencv_transform("mount", "d400_color_optical_frame", np.eye(4))
    loop += opencv_transform("d400_color_optical_frame", "mount", np.eye(4))
    path.write_text("%YAML:1.0\ntrans_matrix:\n" + loop)
    with pytest.raises(InputError, match="no chain of frames"):
        _ = open_sequence(folder).groundtruth
    path.write_text("%YAML:1.0\ntrans_matrix:\n   - {child_frame: a, parent_frame: b}\n")
    with pytest.raises(InputError, match="has no finite 4x4 matrix"):
        _ = open_sequence(folder).groundtruth
    path.unlink()
    with pytest.raises(InputError, match=r"trans_matrix\.yaml is missing: without it the truth"):
        _ = open_sequence(folder).groundtruth
    (folder / "groundtruth.txt").unlink()
    assert open_sequence(folder).groundtruth is None


# --- Redwood/Open3D


@pytest.mark.parametrize("colour", ["color", "image", "rgb"])
def test_redwood(tmp_path: Path, colour: str) -> None:
    scene = Scene(frames=4)
    sequence = open_sequence(write_redwood(tmp_path / "bedroom", colour=colour))
    assert (sequence.format, sequence.calibration.fx, sequence.calibration.cy) == (
        "Redwood/Open3D",
        60.0,
        23.5,
    )
    assert sequence.calibration.depth_scale == 1000.0
    assert [frame.timestamp for frame in sequence.frames] == pytest.approx([0, 1 / 30, 2 / 30, 3 / 30])
    assert sequence.frames[0].load()[1][0, 0] == 2000
    truth = sequence.groundtruth
    assert truth is not None
    np.testing.assert_allclose(truth.poses[3], scene.pose(3), atol=1e-6)
    assert sequence.warnings == []
    for path in (sequence.path, sequence.path / "trajectory.log"):
        np.testing.assert_allclose(read_groundtruth(path).poses, truth.poses)


def test_redwood_without_a_camera_file_says_what_it_takes(tmp_path: Path) -> None:
    sequence = open_sequence(write_redwood(tmp_path / "bedroom", frames=2, camera=False))
    assert (sequence.calibration.fx, sequence.calibration.width) == (525.0, 640)
    assert "no camera_intrinsic.json, Redwood's PrimeSense assumed (525 pixels)" in sequence.warnings[0]
    assert sequence.frames[1].load()[0].shape == (480, 640, 3)


def test_redwood_object_scans_are_paired_by_the_time_in_their_names(tmp_path: Path) -> None:
    folder = write_redwood(tmp_path / "00033")
    scene = Scene(frames=4, depth_scale=1000.0)
    for name in ("color", "depth"):
        shutil.rmtree(folder / name)
    for index in range(4):
        save(scene.rgb(index), folder / f"rgb/{index + 1:07d}-{index * 33333:012d}.jpg")
        if index != 2:
            save(scene.depth(index), folder / f"depth/{index + 5:07d}-{index * 33333 + 9000:012d}.png")
    sequence = open_sequence(folder)
    assert [frame.timestamp for frame in sequence.frames] == pytest.approx([0, 0.033333, 0.099999])
    assert "1 of 4 colour images have no depth within 0.02 s" in sequence.warnings[0]
    assert sequence.groundtruth is not None
    assert sequence.groundtruth.timestamps == pytest.approx([0, 0.033333, 0.066666, 0.099999])


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ("{", "expected .*intrinsic_matrix"),
        ("[]", "expected .*intrinsic_matrix"),
        ({"width": 64}, "KeyError: 'height'"),
        ({"width": 64, "height": 48, "intrinsic_matrix": [1, 2]}, "has 2 numbers, expected 9"),
        ({"width": 64, "height": 48, "intrinsic_matrix": [60, 0, 30, 0, 60, 20, 0, 0, 1]}, "row by row"),
        ({"width": 64, "height": 48, "intrinsic_matrix": [0, 0, 0, 0, 60, 0, 30, 20, 1]}, "fx is 0.0"),
    ],
)
def test_redwood_camera_damage(tmp_path: Path, values: object, message: str) -> None:
    folder = write_redwood(tmp_path / "bedroom")
    path = folder / "camera_intrinsic.json"
    path.write_text(values if isinstance(values, str) else json.dumps(values))
    with pytest.raises(InputError, match=f"camera_intrinsic.json:.*{message}") as caught:
        open_sequence(folder)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "0 lines, expected five for each pose"),
        ("0 0 1\n1 0 0 0\n0 1 0 0\n", "3 lines, expected five for each pose"),
        ("0 0 1\n1 0 0\n", "trajectory.log:2: expected 4 numbers"),
        ("0 0 one\n", "trajectory.log:1: expected 3 numbers"),
    ],
)
def test_redwood_truth_damage(tmp_path: Path, text: str, message: str) -> None:
    folder = write_redwood(tmp_path / "bedroom")
    (folder / "trajectory.log").write_text(text)
    with pytest.raises(InputError, match=message):
        _ = open_sequence(folder).groundtruth


def test_redwood_counts_that_differ(tmp_path: Path) -> None:
    folder = write_redwood(tmp_path / "bedroom")
    (folder / "color/00001.jpg").unlink()
    sequence = open_sequence(folder)
    assert len(sequence.frames) == 3
    assert "depth: 1 of 4 images have no partner in color, left out" in sequence.warnings[0]
    truth = sequence.groundtruth
    assert truth is not None
    assert "4 poses for 3 colour images, by order" in truth.notes[0]
