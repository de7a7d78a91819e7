"""The examples in Python do what they say."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

from conftest import report

EXAMPLES = Path(__file__).resolve().parent.parent / "examples"


def ran(name: str, *arguments: object) -> list[str]:
    """The lines that an example printed."""
    command = [sys.executable, str(EXAMPLES / name), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return done.stdout.splitlines()


def test_run_folder(recorded: Path, tmp_path: Path) -> None:
    lines = ran("run_folder.py", recorded, tmp_path / "out")
    assert lines[0] == "100.000 s: keyframe"
    assert any(line.startswith("60 poses, {") for line in lines)
    assert "trajectory.txt" in lines[-1]
    assert report(tmp_path / "out")["tracked"] == 60


def test_track_folder(recorded: Path) -> None:
    assert "60 of 60 frames tracked" in ran("track_folder.py", recorded)


def test_live_camera(recorded: Path, tmp_path: Path) -> None:
    lines = ran("live_camera.py", recorded, tmp_path / "out", 5)
    run = report(tmp_path / "out")
    assert lines[0] == "the camera is let go"
    assert lines[1].startswith(f"{run['tracked']} frames tracked, ")
    assert run["source"] == {"name": "live camera"}
    assert run["configuration"]["system.realtime"] is True
    assert run["frames"] == 60
    assert run["tracked"] + run["skipped"].get("dropped", 0) == 60


def test_custom_exporter(recorded: Path, tmp_path: Path) -> None:
    (path,) = ran("custom_exporter.py", recorded, tmp_path / "out")
    assert Path(path) == tmp_path / "out" / "rooms.geojson"
    assert json.loads(Path(path).read_text())["type"] == "FeatureCollection"
