"""What goes wrong in a run: damage costs only itself, mistakes end with one line."""

from __future__ import annotations

import resource
from pathlib import Path

import numpy as np
import pytest
from conftest import Program, one_line_error, report
from layouts import save, sliding_scene, write_tum
from PIL import Image

from vsgraphs.trajectory import read_tum_trajectory


def test_damaged_frames_cost_only_themselves(sequence: Path, tmp_path: Path, vsgraphs: Program) -> None:
    images = sorted((sequence / "rgb").iterdir())
    depths = sorted((sequence / "depth").iterdir())
    images[10].write_bytes(images[10].read_bytes()[:3000])
    depths[20].write_bytes(depths[20].read_bytes()[:100])
    images[30].unlink()
    save(np.zeros((120, 160), np.uint16), depths[40])
    lines = (sequence / "rgb.txt").read_text().splitlines()
    lines[51] = f"nan {lines[51].split()[1]}"
    (sequence / "rgb.txt").write_text("\n".join(lines))
    out = tmp_path / "out"
    done = vsgraphs("run", sequence, "--out", out)
    assert done.returncode == 0, done.stderr
    run = report(out)
    assert (run["frames"], run["tracked"]) == (60, 55)
    assert run["skipped"] == {"damaged": 4, "not_finite_timestamp": 1}
    assert run["completion"] == pytest.approx(55 / 60)
    assert len([line for line in run["warnings"] if "skipped" in line]) == 5
    assert "Traceback" not in done.stderr


def test_a_sequence_of_nothing_but_damage_ends_with_one_line(
    sequence: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    for path in (sequence / "depth").iterdir():
        path.write_bytes(path.read_bytes()[:50])
    error = one_line_error(vsgraphs("run", sequence, "--out", tmp_path / "out"))
    assert "none of the 60 frames" in error
    assert "is damaged" in error


def test_images_of_another_size_than_the_camera(sequence: Path, tmp_path: Path, vsgraphs: Program) -> None:
    text = (sequence / "camera.yaml").read_text()
    (sequence / "camera.yaml").write_text(text.replace("width: 320", "width: 640"))
    error = one_line_error(vsgraphs("run", sequence, "--out", tmp_path / "out"))
    assert "320x240 pixels, the camera has 640x240" in error


def test_depth_all_zero(sequence: Path, tmp_path: Path, vsgraphs: Program) -> None:
    for path in (sequence / "depth").iterdir():
        save(np.zeros((240, 320), np.uint16), path)
    error = one_line_error(vsgraphs("run", sequence, "--out", tmp_path / "out"))
    assert "no frame of" in error
    assert "depth" in error


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            ["--set", "tracker.coast=3"],
            r"--set tracker.coast=3: unknown option 'tracker.coast'; did you mean 'tracker.",
        ),
        (["--set", "system.seed=-4"], "system.seed"),
        (["--set", "system.seed"], "expected KEY=VALUE"),
        (["--execution", "parallel"], "--execution parallel"),
        (["--mode", "magic"], "--mode magic"),
        (["--config", "/nonexistent/c.yaml"], "cannot read configuration /nonexistent/c.yaml"),
        (["--camera", "kinect9"], "camera 'kinect9' is neither a file nor one of"),
        (["--replay", "/nonexistent/s.txt"], "/nonexistent/s.txt"),
        (["--schedule-out", "/nonexistent/s.txt"], "/nonexistent is not a directory that can be written to"),
    ],
)
def test_mistaken_options(
    recorded: Path, tmp_path: Path, vsgraphs: Program, options: list[str], message: str
) -> None:
    assert message in one_line_error(vsgraphs("run", recorded, "--out", tmp_path / "out", *options))


def test_a_config_file_s_mistake_is_named_by_line(recorded: Path, tmp_path: Path, vsgraphs: Program) -> None:
    settings = tmp_path / "mine.yaml"
    settings.write_text("system:\n  sed: 5\n")
    error = one_line_error(vsgraphs("run", recorded, "--out", tmp_path / "out", "--config", settings))
    assert "mine.yaml:2: unknown option 'system.sed'; did you mean 'system.seed'?" in error


def test_sources_that_are_none(tmp_path: Path, vsgraphs: Program) -> None:
    empty = tmp_path / "empty"
    empty.mkdir()
    assert "does not exist" in one_line_error(vsgraphs("run", tmp_path / "no", "--out", tmp_path / "out"))
    assert "is empty; looked for" in one_line_error(vsgraphs("run", empty, "--out", tmp_path / "out"))


def test_output_that_cannot_be_written_fails_before_the_run(
    recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    file = tmp_path / "file"
    file.write_text("precious")
    assert "is a file; give a directory" in one_line_error(vsgraphs("run", recorded, "--out", file))
    assert file.read_text() == "precious"
    done = vsgraphs("run", recorded, "--out", "/proc/vsgraphs")
    assert "cannot create output directory /proc/vsgraphs" in one_line_error(done)
    assert "tracked" not in done.stdout


def test_a_full_disk_is_one_line_and_leaves_no_half_file(
    recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / "map.ply").write_text("of an earlier run")

    def little_room() -> None:
        resource.setrlimit(
            resource.RLIMIT_FSIZE, (8000, 8000)
        )  # stands in for a full disk: writes fail midway

    error = one_line_error(vsgraphs("run", recorded, "--out", out, preexec_fn=little_room))
    assert "cannot write" in error
    assert "File too large" in error
    missing, _, written = error.partition("; written: ")
    assert "map.ply" in missing
    assert written.startswith("trajectory.txt, scene_graph.json, keyframes.txt")
    assert len((out / "trajectory.txt").read_text().splitlines()) >= 60  # small enough: kept
    assert [path.name for path in tmp_path.iterdir()] == ["out"]  # there is no more room beside it
    assert (out / "map.ply").read_text() == "of an earlier run"
    assert not [path for path in out.iterdir() if path.name.endswith(".part")]


def test_black_for_three_seconds_and_back(tmp_path: Path, vsgraphs: Program) -> None:
    there = [2 * i for i in range(30)]
    folder = write_tum(tmp_path / "s", sliding_scene(there + [there[-1]] * 30 + there[::-1]))
    for path in sorted((folder / "rgb").iterdir())[30:60]:
        Image.new("RGB", (320, 240)).save(path)
    for path in sorted((folder / "depth").iterdir())[30:60]:
        save(np.zeros((240, 320), np.uint16), path)
    done = vsgraphs("run", folder, "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    run = report(tmp_path / "out")
    assert any(line.startswith("lost at frame ") for line in run["warnings"])
    assert any(line.startswith("relocalised at frame ") for line in run["warnings"])
    assert "relocalised at frame " in done.stderr
    trajectory = read_tum_trajectory(tmp_path / "out" / "trajectory.txt")
    truth = read_tum_trajectory(folder / "groundtruth.txt")
    after = trajectory.timestamps >= truth.timestamps[62]
    assert np.count_nonzero(after) >= 25
    expected = truth.positions[-np.count_nonzero(after) :]
    assert np.abs(trajectory.positions[after] - expected).max() < 0.03
