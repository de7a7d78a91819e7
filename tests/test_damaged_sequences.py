from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from layouts import Scene, save, write_tum

from vsgraphs.datasets import open_sequence
from vsgraphs.errors import FrameError, InputError


def test_what_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere does not exist"):
        open_sequence(tmp_path / "nowhere")
    file = tmp_path / "video.mp4"
    file.write_bytes(b"x")
    with pytest.raises(InputError, match="is a file; expected the folder"):
        open_sequence(file)


def test_empty_folder_says_what_was_looked_for(tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        open_sequence(tmp_path)
    message = str(caught.value)
    assert "is empty" in message
    for word in ("rgb.txt", "associations.txt", "frame-XXXXXX.color.png", "traj.txt"):
        assert word in message
    assert "\n" not in message


def test_folder_of_something_else(tmp_path: Path) -> None:
    (tmp_path / "notes.md").write_text("hello")
    with pytest.raises(InputError, match="holds no sequence in a known format; looked for"):
        open_sequence(tmp_path)


def test_no_association_tells_the_smallest_gap(tmp_path: Path) -> None:
    folder = write_tum(tmp_path / "desk")
    lines = (folder / "depth.txt").read_text().splitlines()[1:]
    late = [f"{float(line.split()[0]) + 3600.046:.6f} {line.split()[1]}" for line in lines]
    (folder / "depth.txt").write_text("\n".join(late))
    with pytest.raises(InputError, match=r"within 0\.02 s.*smallest gap .* is 3599\.35 s"):
        open_sequence(folder)


def test_missing_camera_names_the_known_ones(tmp_path: Path) -> None:
    folder = write_tum(tmp_path / "desk")
    (folder / "camera.yaml").unlink()
    with pytest.raises(InputError, match=r"no camera for .*--camera FILE or one of .*tum-fr1"):
        open_sequence(folder)
    with pytest.raises(InputError, match=r"camera 'tum-f1' is neither .* did you mean 'tum-fr1'"):
        open_sequence(folder, "tum-f1")


@pytest.mark.parametrize("name", ["rgb.txt", "depth.txt"])
def test_empty_and_broken_lists(tmp_path: Path, name: str) -> None:
    folder = write_tum(tmp_path / "desk")
    path = folder / name
    path.write_text("# only a comment\n")
    with pytest.raises(InputError, match="lists no images"):
        open_sequence(folder)
    path.write_text("100.0 a.png\n100.1\n")
    with pytest.raises(InputError, match=rf"{name}:2: 1 fields"):
        open_sequence(folder)
    path.write_text("yesterday a.png\n")
    with pytest.raises(InputError, match="timestamp 'yesterday' is not a number"):
        open_sequence(folder)
    path.write_text("nan a.png\ninf b.png\n")
    with pytest.raises(InputError, match="none of the 2 timestamps is a number"):
        open_sequence(folder)


def stamps_edited(folder: Path, edits: dict[int, str]) -> Path:
    """Replaces the timestamps of some frames of a TUM associations file."""
    path = folder / "associations.txt"
    lines = path.read_text().splitlines()
    for index, stamp in edits.items():
        lines[index] = " ".join([stamp, *lines[index].split()[1:]])
    path.write_text("\n".join(lines))
    return folder


def long_sequence(folder: Path) -> Path:
    return write_tum(folder, Scene(frames=30, width=16, height=12), associations=True)


def test_nan_timestamp_is_skipped_and_counted(tmp_path: Path) -> None:
    sequence = open_sequence(stamps_edited(long_sequence(tmp_path / "s"), {4: "nan", 9: "inf"}))
    assert len(sequence.frames) == 28
    assert sequence.skipped == {"not_finite_timestamp": 2}
    assert "2 timestamps that are no number of seconds, skipped" in sequence.warnings[0]


def test_repeated_and_backward_timestamps_are_skipped_and_counted(tmp_path: Path) -> None:
    folder = stamps_edited(long_sequence(tmp_path / "s"), {4: "100.300000", 9: "100.200000"})
    sequence = open_sequence(folder)
    stamps = [frame.timestamp for frame in sequence.frames]
    assert len(stamps) == 28
    assert all(np.diff(stamps) > 0)
    assert sequence.skipped == {"repeated_or_backward_timestamp": 2}
    assert "2 repeated or backward timestamps, skipped" in sequence.warnings[0]


def test_one_stamp_far_ahead_costs_one_frame_not_the_rest(tmp_path: Path) -> None:
    sequence = open_sequence(stamps_edited(long_sequence(tmp_path / "s"), {4: "99999.0"}))
    assert len(sequence.frames) == 30
    assert "not in order of time, sorted" in sequence.warnings[0]


def test_list_out_of_order_is_sorted(tmp_path: Path) -> None:
    folder = long_sequence(tmp_path / "s")
    path = folder / "associations.txt"
    path.write_text("\n".join(reversed(path.read_text().splitlines())))
    sequence = open_sequence(folder)
    stamps = [frame.timestamp for frame in sequence.frames]
    assert len(stamps) == 30
    assert all(np.diff(stamps) > 0)
    assert sequence.skipped == {}
    assert sequence.warnings == ["associations.txt: not in order of time, sorted"]


def test_damaged_images_raise_frame_errors_that_name_the_file(tmp_path: Path) -> None:
    frames = open_sequence(write_tum(tmp_path / "s")).frames
    whole = frames[0].depth_path.read_bytes()
    frames[0].depth_path.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(FrameError, match=r"depth/.*\.png is damaged: "):
        frames[0].load()
    frames[1].rgb_path.unlink()
    with pytest.raises(FrameError, match=r"rgb/.*\.png is missing"):
        frames[1].load()
    frames[2].rgb_path.write_bytes(b"")
    with pytest.raises(FrameError, match="not a JPEG or PNG image"):
        frames[2].load()
    save(np.zeros((47, 64), np.uint16), frames[3].depth_path)
    with pytest.raises(FrameError, match=r"64x47 pixels, the camera has 64x48"):
        frames[3].load()
    save(np.zeros((48, 64), np.uint8), frames[4].depth_path)
    with pytest.raises(FrameError, match="a L image where 16-bit depth is expected"):
        frames[4].load()
    save(np.zeros((48, 64), np.uint16), frames[5].rgb_path)
    with pytest.raises(FrameError, match="I;16 image where colour is expected"):
        frames[5].load()
    frames[6].rgb_path.unlink()
    frames[6].rgb_path.mkdir()
    with pytest.raises(FrameError, match="it is a folder"):
        frames[6].load()


def test_truncated_jpeg_is_damaged(tmp_path: Path) -> None:
    from vsgraphs.datasets.decode import load_rgb

    path = tmp_path / "a.jpg"
    save(np.random.default_rng(0).integers(0, 255, (48, 64, 3), np.uint8), path)
    path.write_bytes(path.read_bytes()[:-600])
    with pytest.raises(FrameError, match="truncated"):
        load_rgb(path, (64, 48))


def test_corrupt_pixels_of_a_png_are_damage(tmp_path: Path) -> None:
    from vsgraphs.datasets.decode import load_depth

    path = tmp_path / "a.png"
    save(np.random.default_rng(0).integers(0, 9000, (48, 64)).astype(np.uint16), path)
    data = bytearray(path.read_bytes())
    data[len(data) // 2 : len(data) // 2 + 40] = bytes(40)
    path.write_bytes(data)
    with pytest.raises(FrameError, match=r"a\.png is damaged"):
        load_depth(path, (64, 48))


@pytest.mark.parametrize("stamp", ["1e300", "-1e300", "1700000000000000000"])
def test_a_timestamp_beyond_all_time_is_skipped(tmp_path: Path, stamp: str) -> None:
    folder = write_tum(tmp_path / "s", Scene(frames=6))
    lines = (folder / "rgb.txt").read_text().splitlines()
    lines[-1] = f"{stamp} {lines[-1].split()[1]}"
    (folder / "rgb.txt").write_text("\n".join(lines))
    sequence = open_sequence(folder)
    assert len(sequence.frames) == 5
    assert sequence.skipped == {"not_finite_timestamp": 1}


def test_nanoseconds_are_no_seconds(tmp_path: Path) -> None:
    folder = write_tum(tmp_path / "s", Scene(frames=6))
    for name in ("rgb.txt", "depth.txt"):
        rows = [line.split() for line in (folder / name).read_text().splitlines() if line[0] != "#"]
        rows = [[f"{float(stamp) * 1e9:.0f}", file] for stamp, file in rows]
        (folder / name).write_text("\n".join(map(" ".join, rows)))
    with pytest.raises(InputError, match="none of the 6 timestamps is a number of seconds"):
        open_sequence(folder)
