"""The command `run` in a process of its own, on a small sequence with exact truth."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import fake_core
import numpy as np
import pytest
from conftest import Program, one_line_error, report

from vsgraphs.cli.run import run_sequence
from vsgraphs.run import RunRequest
from vsgraphs.trajectory import read_tum_trajectory

OUTPUTS = (
    "trajectory.txt",
    "keyframes.txt",
    "map.ply",
    "scene_graph.json",
    "scene_graph.dsg.json",
    "floorplan.svg",
    "planes.ply",
    "run.json",
    "timeline.json",
)
RUN_KEYS = [
    "frames",
    "tracked",
    "completion",
    "keyframes",
    "landmarks",
    "wall_s",
    "waited_s",
    "cpu_s",
    "fps",
    "peak_memory_mb",
    "startup_s",
    "stages",
    "versions",
    "commit",
    "configuration",
    "seed",
    "warnings",
]
STAGE_KEYS = ["count", "median_ms", "p95_ms", "max_ms", "cpu_median_ms", "cpu_p95_ms"]


def test_everything_a_run_leaves(recorded: Path, tmp_path: Path, vsgraphs: Program) -> None:
    out = tmp_path / "new" / "out"
    done = vsgraphs("run", recorded, "--out", out)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("TUM RGB-D sequence slide: 60 frames, 5.9 s, with ground truth")
    assert "tracked 60 of 60 frames (100.0 %)" in done.stdout
    assert sorted(path.name for path in out.iterdir()) == sorted(OUTPUTS)

    run = report(out)
    assert not [key for key in RUN_KEYS if key not in run]
    assert (run["frames"], run["tracked"], run["completion"]) == (60, 60, 1.0)
    assert list(run["stages"]["track"]) == STAGE_KEYS
    assert run["stages"]["track"]["count"] == 60
    assert run["configuration"]["system.execution"] == "threaded"
    assert 0 < run["startup_s"] < run["wall_s"] + 10
    assert 20 < run["peak_memory_mb"] < 400
    assert run["cpu_s"] > 0
    assert run["fps"] == pytest.approx(60 / run["wall_s"])
    assert run["versions"]["numpy"] == np.__version__

    trajectory = read_tum_trajectory(out / "trajectory.txt")
    truth = read_tum_trajectory(recorded / "groundtruth.txt")
    np.testing.assert_allclose(trajectory.timestamps, truth.timestamps, atol=1e-6)
    assert np.abs(trajectory.positions - truth.positions).max() < 0.02
    keyframes = read_tum_trajectory(out / "keyframes.txt")
    assert len(keyframes) == run["keyframes"] >= 1
    assert set(keyframes.timestamps) <= set(trajectory.timestamps)

    header, _, body = (out / "map.ply").read_bytes().partition(b"end_header\n")
    assert f"element vertex {run['landmarks']}\n".encode() in header
    points = np.frombuffer(body, dtype=[("xyz", "<f4", 3), ("rgb", "u1", 3)])
    assert len(points) == run["landmarks"] > 50
    np.testing.assert_allclose(np.median(points["xyz"][:, 2]), 2.0, atol=0.02)  # the wall is 2 m away
    assert len(np.unique(points["rgb"], axis=0)) > 10

    trace = json.loads((out / "timeline.json").read_text())["traceEvents"]
    lanes = {event["args"]["name"] for event in trace if event["name"] == "thread_name"}
    assert {"tracking", "decoding"} <= lanes
    spans = [event for event in trace if event["ph"] == "X"]
    assert min(span["ts"] for span in spans) == 0
    assert max(span["ts"] + span["dur"] for span in spans) < 1e6 * (run["wall_s"] + 2)


def test_serial_leaves_the_same_bytes(recorded: Path, tmp_path: Path, vsgraphs: Program) -> None:
    for name in "ab":
        done = vsgraphs("run", recorded, "--out", tmp_path / name, "--execution", "serial", "--seed", "3")
        assert done.returncode == 0, done.stderr
    for name in OUTPUTS[:3]:
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()
    assert report(tmp_path / "a")["seed"] == 3


def test_a_recorded_schedule_is_replayed_exactly(recorded: Path, tmp_path: Path, vsgraphs: Program) -> None:
    schedule = tmp_path / "schedule.txt"
    assert vsgraphs("run", recorded, "--out", tmp_path / "a", "--schedule-out", schedule).returncode == 0
    done = vsgraphs("run", recorded, "--out", tmp_path / "b", "--replay", schedule)
    assert done.returncode == 0, done.stderr
    for name in OUTPUTS[:3]:
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_realtime_takes_the_recording_s_time(recorded: Path, tmp_path: Path, vsgraphs: Program) -> None:
    done = vsgraphs("run", recorded, "--out", tmp_path, "--realtime", "--max-frames", 21)
    assert done.returncode == 0, done.stderr
    run = report(tmp_path)
    assert run["frames"] == 21
    assert run["wall_s"] >= 2.0
    assert run["tracked"] + run["skipped"].get("dropped", 0) == 21
    assert run["configuration"]["system.realtime"] is True


def test_options_reach_the_core(recorded: Path, tmp_path: Path, vsgraphs: Program) -> None:
    settings = tmp_path / "mine.yaml"
    settings.write_text("system:\n  seed: 5\n  min_map_keyframes: 4\n")
    done = vsgraphs(
        *("run", recorded, "--out", tmp_path / "o", "--config", settings, "--max-frames", 3),
        *("--set", "system.min_map_keyframes=3", "--mode", "slam"),
    )
    assert done.returncode == 0, done.stderr
    configuration = report(tmp_path / "o")["configuration"]
    assert configuration["system.seed"] == 5
    assert configuration["system.min_map_keyframes"] == 3  # the command line has the last word


@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)]
)
def test_interrupted_runs_keep_their_results(
    recorded: Path, tmp_path: Path, number: signal.Signals, code: int
) -> None:
    out = tmp_path / "out"
    atlas = tmp_path / "atlas.vsg"  # there once something was tracked
    command = [sys.executable, "-m", "vsgraphs", "run", str(recorded), "--out", str(out), "--realtime"]
    command += ["--save-atlas", str(atlas), "--autosave", "0.3"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        deadline = time.monotonic() + 60
        while not atlas.exists():
            assert time.monotonic() < deadline
            time.sleep(0.02)
        process.send_signal(number)
        _, errors = process.communicate(timeout=60)
    assert process.returncode == code, errors
    assert "results so far are kept" in errors
    run = report(out)
    assert run["interrupted"] is True
    assert 0 < run["tracked"] <= run["frames"] < 60
    assert len(read_tum_trajectory(out / "trajectory.txt")) == run["tracked"]
    assert sorted(path.name for path in out.iterdir()) == sorted(OUTPUTS)


def test_a_defect_of_ours_keeps_what_was_tracked(
    recorded: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Breaking(fake_core.Slam):
        def track(self, rgb: np.ndarray, depth: np.ndarray, timestamp: float) -> fake_core.Result:
            if self.seen == 10:
                raise RuntimeError("invariant")
            return super().track(rgb, depth, timestamp)

    core = SimpleNamespace(
        Config=fake_core.Config, Camera=lambda *_, **__: None, Slam=lambda config, camera: Breaking()
    )
    monkeypatch.setattr("vsgraphs.compiled.core", lambda: core)
    monkeypatch.setattr("vsgraphs.run.report.core", lambda: core)
    with pytest.raises(RuntimeError, match="invariant"):
        run_sequence(RunRequest(recorded, tmp_path))
    assert report(tmp_path)["tracked"] == 10
    assert len(read_tum_trajectory(tmp_path / "trajectory.txt")) == 10


def test_version_and_help(vsgraphs: Program) -> None:
    done = vsgraphs("--version")
    assert done.returncode == 0
    assert done.stdout.startswith("vsgraphs ")
    for command in ("run", "eval", "simulate", "config"):
        assert command in vsgraphs("--help").stdout


def test_config_lists_every_option(vsgraphs: Program, recorded: Path, tmp_path: Path) -> None:
    from vsgraphs import Config

    listed = vsgraphs("config", env={"COLUMNS": "200", **_environment()}).stdout
    for key in Config().keys():  # noqa: SIM118  (not a mapping)
        assert key in listed
    settings = tmp_path / "all.yaml"
    settings.write_text(vsgraphs("config", "--yaml").stdout)
    done = vsgraphs("run", recorded, "--out", tmp_path / "o", "--config", settings, "--max-frames", 2)
    assert done.returncode == 0, done.stderr
    assert "no option's key contains 'qwerty'" in one_line_error(vsgraphs("config", "qwerty"))


def _environment() -> dict[str, str]:
    import os

    return dict(os.environ)
