from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
from conftest import Program
from layouts import Scene, write_icl, write_replica, write_seven_scenes, write_tum

from vsgraphs.cli.compare import read_groundtruth
from vsgraphs.errors import InputError
from vsgraphs.trajectory import format_tum, read_tum_trajectory

SHARED = ("sevenscenes_redkitchen", "tum_fr1_xyz_first230", "rendered_room")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    shifts = [int(20 * np.sin(i / 5) + 20) + i for i in range(40)]
    return write_tum(tmp_path / "s", Scene(frames=40, width=16, height=12, shifts_px=shifts))


def noisy_copy(truth: Path, path: Path, *, every: int = 1) -> Path:
    trajectory = read_tum_trajectory(truth)
    poses = trajectory.poses[::every].copy()
    poses[:, :3, 3] += np.random.default_rng(0).normal(0, 0.02, (len(poses), 3))
    path.write_text(format_tum(trajectory.timestamps[::every], poses))
    return path


def test_table_json_and_plot(folder: Path, tmp_path: Path, vsgraphs: Program) -> None:
    estimate = noisy_copy(folder / "groundtruth.txt", tmp_path / "t.txt")
    json_file, plot = tmp_path / "e.json", tmp_path / "p.svg"
    done = vsgraphs(
        "eval", estimate, "--groundtruth", folder / "groundtruth.txt", "--json", json_file, "--plot", plot
    )
    assert done.returncode == 0, done.stderr
    assert "ATE" in done.stdout
    assert "completion 100.00 %; 40 poses paired" in done.stdout
    figures = json.loads(json_file.read_text())
    assert set(figures["ate"]) == {"rmse_m", "mean_m", "median_m", "max_m"}
    assert 0.02 < figures["ate"]["rmse_m"] < 0.04
    assert set(figures["rpe"]) == {"per_metre", "per_second"}
    assert figures["rpe"]["per_second"]["translation_rmse_m"] > 0
    assert figures["completion"] == 1.0
    assert "<svg" in plot.read_text()


def test_completion_counts_the_frames_of_the_sequence(
    folder: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    estimate = noisy_copy(folder / "groundtruth.txt", tmp_path / "t.txt", every=2)
    done = vsgraphs("eval", estimate, "--groundtruth", folder)
    assert "completion 50.00 %" in done.stdout
    # A run told to stop after 20 frames is measured against those 20.
    (tmp_path / "run.json").write_text('{"frames": 20, "completion": 0.9}')
    short = tmp_path / "trajectory.txt"
    short.write_text("".join(estimate.read_text().splitlines(keepends=True)[:11]))
    done = vsgraphs("eval", tmp_path, "--groundtruth", folder)
    assert "completion 50.00 %" in done.stdout
    # The truth alone, far from its sequence: what the run itself says; without a run, unknown.
    lonely = tmp_path / "elsewhere" / "truth.txt"
    lonely.parent.mkdir()
    shutil.copy(folder / "groundtruth.txt", lonely)
    assert "completion 90.00 %" in vsgraphs("eval", short, "--groundtruth", lonely).stdout
    (tmp_path / "run.json").unlink()
    done = vsgraphs("eval", short, "--groundtruth", lonely)
    assert "completion unknown" in done.stdout
    done = vsgraphs("eval", short, "--groundtruth", lonely, "--sequence", folder)
    assert "completion 25.00 %" in done.stdout


def test_truth_of_every_format(tmp_path: Path) -> None:
    icl = write_icl(tmp_path / "icl")
    assert len(read_groundtruth(icl)) == 4
    assert read_groundtruth(icl / "livingRoom2.gt.freiburg").positions[3, 1] == pytest.approx(-0.06)
    assert len(read_groundtruth(write_seven_scenes(tmp_path / "seq-01"))) == 2
    replica = write_replica(tmp_path / "office0")
    assert len(read_groundtruth(replica / "traj.txt")) == len(read_groundtruth(replica)) == 3
    bare = write_tum(tmp_path / "bare")
    (bare / "groundtruth.txt").unlink()
    with pytest.raises(InputError, match="has no ground truth"):
        read_groundtruth(bare)


def test_mistakes_are_one_line(folder: Path, tmp_path: Path, vsgraphs: Program) -> None:
    estimate = noisy_copy(folder / "groundtruth.txt", tmp_path / "t.txt")
    truth = folder / "groundtruth.txt"
    late = tmp_path / "late.txt"
    late.write_text("".join(f"{i} 0 0 0 0 0 0 1\n" for i in range(9000, 9010)))
    broken = tmp_path / "broken.txt"
    broken.write_text("1 2 3\n")
    cases = [
        (["eval", tmp_path / "none.txt", "--groundtruth", truth], "cannot read"),
        (["eval", estimate, "--groundtruth", tmp_path / "none.txt"], "does not exist"),
        (["eval", estimate, "--groundtruth", late], "no pose lies within 0.01 s"),
        (["eval", broken, "--groundtruth", truth], "broken.txt:1: 3 numbers"),
        (["eval", estimate, "--groundtruth", truth, "--plot", tmp_path / "p.gif"], "ending in .png or .svg"),
        (["eval", estimate, "--groundtruth", truth, "--json", tmp_path / "no" / "e.json"], "cannot write"),
        (["eval", estimate, "--groundtruth", truth, "--max-dt", "0"], "must be positive"),
    ]
    for arguments, message in cases:
        done = vsgraphs(*arguments)
        assert done.returncode == 2, (arguments, done.stderr)
        assert done.stderr.startswith("error: ")
        assert done.stderr.count("\n") == 1
        assert message in done.stderr


def test_repairs_of_the_truth_are_told(folder: Path, tmp_path: Path, vsgraphs: Program) -> None:
    truth = folder / "groundtruth.txt"
    estimate = noisy_copy(truth, tmp_path / "t.txt")
    lines = truth.read_text().splitlines()
    truth.write_text("\n".join([*reversed(lines), lines[5], "nan 0 0 0 0 0 0 1"]))
    done = vsgraphs("eval", estimate, "--groundtruth", truth)
    assert done.returncode == 0, done.stderr
    assert "1 of 42 poses are not finite" in done.stdout
    assert "sorted" in done.stdout
    assert "1 repeated timestamps" in done.stdout


def evo_figures(truth: Path, estimate: Path, home: Path) -> dict[str, float]:
    program = Path(sys.executable).with_name("evo_ape")
    if not program.exists():
        pytest.skip("evo is not installed: nothing to compare with")
    results = home / "evo.zip"
    command = [program, "tum", truth, estimate, "-a", "--save_results", results, "--no_warnings"]
    subprocess.run(
        command, check=True, capture_output=True, env={**os.environ, "HOME": str(home), "MPLBACKEND": "agg"}
    )
    with zipfile.ZipFile(results) as archive:
        return json.loads(archive.read("stats.json"))


def compared(truth: Path, estimate: Path, tmp_path: Path, vsgraphs: Program) -> None:
    theirs = evo_figures(truth, estimate, tmp_path)
    done = vsgraphs("eval", estimate, "--groundtruth", truth, "--json", tmp_path / "e.json")
    assert done.returncode == 0, done.stderr
    ours = json.loads((tmp_path / "e.json").read_text())["ate"]
    for name in ("rmse", "mean", "median", "max"):
        assert ours[f"{name}_m"] == pytest.approx(theirs[name], abs=1e-6)


def test_ate_equals_evo_s(tmp_path: Path, vsgraphs: Program) -> None:
    t = np.arange(120) / 30
    poses = np.tile(np.eye(4), (120, 1, 1))
    poses[:, :3, 3] = np.stack([np.sin(t), np.cos(2 * t), t / 3], axis=1)  # evo aligns no straight line
    truth = tmp_path / "truth.txt"
    truth.write_text(format_tum(t, poses))
    compared(truth, noisy_copy(truth, tmp_path / "t.txt", every=3), tmp_path, vsgraphs)


@pytest.mark.data
@pytest.mark.parametrize("name", SHARED)
def test_ate_equals_evo_s_on_recorded_sequences(
    name: str, shared_data: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    done = vsgraphs("run", shared_data / name, "--out", tmp_path / "out", "--max-frames", 120)
    assert done.returncode == 0, done.stderr
    compared(shared_data / name / "groundtruth.txt", tmp_path / "out" / "trajectory.txt", tmp_path, vsgraphs)
