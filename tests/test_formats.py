from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from layouts import Scene, save, write_icl, write_replica, write_seven_scenes, write_tum

from vsgraphs.datasets import open_sequence
from vsgraphs.errors import InputError


@pytest.mark.parametrize("associations", [False, True])
def test_tum(tmp_path: Path, associations: bool) -> None:
    scene = Scene()
    sequence = open_sequence(write_tum(tmp_path / "desk", scene, associations=associations))
    assert (sequence.format, sequence.name) == ("TUM RGB-D", "desk")
    assert [frame.timestamp for frame in sequence.frames] == pytest.approx([scene.stamp(i) for i in range(8)])
    rgb, depth = sequence.frames[3].load()
    assert (rgb.dtype, depth.dtype) == (np.uint8, np.uint16)
    np.testing.assert_array_equal(rgb, scene.rgb(3))
    np.testing.assert_array_equal(depth, scene.depth(3))
    truth = sequence.groundtruth
    assert truth is not None
    np.testing.assert_allclose(truth.poses[5], scene.pose(5), atol=1e-7)
    assert sequence.warnings == []
    assert "8 frames" in sequence.describe()
    assert "camera.yaml" in sequence.describe()


def test_tum_pairs_one_to_one_and_tells_what_is_left_out(tmp_path: Path) -> None:
    folder = write_tum(tmp_path / "desk")
    lines = (folder / "depth.txt").read_text().splitlines(keepends=True)
    (folder / "depth.txt").write_text("".join(lines[:3] + lines[4:]))  # one depth image was never recorded
    sequence = open_sequence(folder)
    assert len(sequence.frames) == 7
    assert len({frame.depth_path for frame in sequence.frames}) == 7
    assert "1 of 8 images have no depth within 0.02 s" in sequence.warnings[0]


def test_lists_as_other_programs_write_them(tmp_path: Path) -> None:
    folder = write_tum(tmp_path / "desk")
    for name in ("rgb.txt", "groundtruth.txt", "camera.yaml"):
        text = (folder / name).read_text().replace("# colour", "").replace("# truth", "")
        (folder / name).write_bytes(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())
    text = (folder / "depth.txt").read_text()
    (folder / "depth.txt").write_text(text.replace(" depth/", ",\tdepth/"))
    sequence = open_sequence(folder)
    assert len(sequence.frames) == 8
    assert sequence.groundtruth is not None
    assert len(sequence.groundtruth) == 8


def test_tum_without_truth(tmp_path: Path) -> None:
    folder = write_tum(tmp_path / "desk")
    (folder / "groundtruth.txt").unlink()
    assert open_sequence(folder).groundtruth is None


@pytest.mark.parametrize(
    ("name", "fx"),
    [("rgbd_dataset_freiburg1_xyz", 517.3), ("rgbd_dataset_freiburg2_desk", 520.9), ("my_fr3_office", 535.4)],
)
def test_tum_camera_known_by_folder_name(tmp_path: Path, name: str, fx: float) -> None:
    folder = write_tum(tmp_path / name)
    (folder / "camera.yaml").unlink()
    assert open_sequence(folder).calibration.fx == fx


def test_camera_given_by_name_or_file(tmp_path: Path) -> None:
    folder = write_tum(tmp_path / "desk")
    assert open_sequence(folder, "tum-fr2").calibration.fx == 520.9
    assert open_sequence(folder, "FR3").calibration.fx == 535.4
    other = tmp_path / "other.yaml"
    other.write_text((folder / "camera.yaml").read_text().replace("60.0", "61.0"))
    assert open_sequence(folder, other).calibration.fx == 61.0


def test_icl_nuim(tmp_path: Path) -> None:
    sequence = open_sequence(write_icl(tmp_path / "lr_kt2"))
    assert sequence.format == "ICL-NUIM"
    assert sequence.calibration.fy == 480.0  # published as -480: y up
    assert [frame.timestamp for frame in sequence.frames] == pytest.approx([0, 1 / 30, 2 / 30, 3 / 30])
    assert sequence.frames[2].rgb_path.parent.name == "rgb"  # though depth stands first in the list
    truth = sequence.groundtruth
    assert truth is not None
    np.testing.assert_allclose(truth.timestamps, [0, 1 / 30, 2 / 30, 3 / 30])
    np.testing.assert_allclose(truth.positions[3], [0.03, -0.06, 1.5])  # y turned down
    c, s = np.cos(0.2), np.sin(0.2)
    np.testing.assert_allclose(truth.poses[0][:3, :3], [[1, 0, 0], [0, c, s], [0, -s, c]], atol=1e-12)


def test_icl_nuim_with_a_camera_file_of_the_published_sign(tmp_path: Path) -> None:
    folder = write_icl(tmp_path / "lr_kt2")
    text = "width: 640\nheight: 480\nfx: 481.2\nfy: -480\ncx: 319.5\ncy: 239.5\ndepth_scale: 5000\n"
    (folder / "camera.yaml").write_text(text)
    sequence = open_sequence(folder)
    assert (sequence.calibration.fy, sequence.calibration.origin) == (480.0, "camera.yaml")
    assert "y down" in sequence.warnings[0]


def test_icl_nuim_without_truth_is_told_from_tum_by_its_frame_numbers(tmp_path: Path) -> None:
    folder = write_icl(tmp_path / "lr_kt2")
    (folder / "livingRoom2.gt.freiburg").unlink()
    sequence = open_sequence(folder)
    assert (sequence.format, sequence.groundtruth) == ("ICL-NUIM", None)


def test_seven_scenes(tmp_path: Path) -> None:
    sequence = open_sequence(write_seven_scenes(tmp_path / "seq-01"))
    assert sequence.format == "7-Scenes"
    assert (sequence.calibration.depth_scale, sequence.calibration.invalid_depth) == (1000.0, (0, 65535))
    assert [frame.timestamp for frame in sequence.frames] == pytest.approx([0, 1 / 30, 2 / 30])
    assert sequence.frames[1].load()[1][0, 0] == 2000
    truth = sequence.groundtruth
    assert truth is not None
    np.testing.assert_allclose(truth.timestamps, [0, 2 / 30])
    assert "1 of 3 poses are not rigid" in truth.notes[0]


@pytest.mark.parametrize("params", [True, False])
def test_replica(tmp_path: Path, params: bool) -> None:
    sequence = open_sequence(write_replica(tmp_path / "office0", params=params))
    assert sequence.format == "Replica"
    assert sequence.calibration.depth_scale == 6553.5
    assert sequence.calibration.width == (120 if params else 1200)
    truth = sequence.groundtruth
    assert truth is not None
    np.testing.assert_allclose(truth.positions[:, 0], [0, 2 / 60, 4 / 60])
    if params:
        rgb, depth = sequence.frames[2].load()
        assert rgb.shape == (68, 120, 3)
        assert depth[0, 0] == 13107


def test_scene_folder_points_to_its_sequences(tmp_path: Path) -> None:
    write_seven_scenes(tmp_path / "chess" / "seq-02")
    with pytest.raises(InputError, match="seq-02 does: give that one"):
        open_sequence(tmp_path / "chess")


def test_colour_as_jpeg_and_grey(tmp_path: Path) -> None:
    folder = write_tum(tmp_path / "desk", Scene(width=65, height=47))  # odd sizes: no row is aligned
    sequence = open_sequence(folder)
    grey = np.arange(47 * 65, dtype=np.uint32).reshape(47, 65).astype(np.uint8)
    save(grey, sequence.frames[0].rgb_path)
    rgb, _ = sequence.frames[0].load()
    np.testing.assert_array_equal(rgb, np.repeat(grey[:, :, None], 3, axis=2))
    smooth = np.tile(np.linspace(0, 255, 65).astype(np.uint8)[None, :, None], (47, 1, 3))
    jpeg = sequence.frames[1].rgb_path.with_suffix(".jpg")
    save(smooth, jpeg)
    from vsgraphs.datasets.decode import load_rgb

    decoded = load_rgb(jpeg, (65, 47))
    assert np.abs(decoded.astype(int) - smooth).max() < 12
    assert decoded.flags.c_contiguous
