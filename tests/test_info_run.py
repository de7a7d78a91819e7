"""`vsgraphs info RUN_DIR`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from conftest import Program, one_line_error
from scene_worlds import building, camera_poses, perfect_map

from vsgraphs.cli.show_run import describe_run, show_run
from vsgraphs.errors import InputError
from vsgraphs.scene_graph import SceneGraph, format_scene_graph

RUN: dict[str, Any] = {
    "source": {"name": "house", "path": "/recordings/house", "format": "TUM RGB-D", "camera": "camera.yaml"},
    "versions": {"vsgraphs": "0.1.0"},
    "commit": "abc",
    "ended": "2026-05-04T10:30:00+00:00",
    "interrupted": False,
    "frames": 600,
    "tracked": 594,
    "completion": 0.99,
    "keyframes": 80,
    "loops": 2,
    "maps": 1,
    "scene": {"walls": 16, "rooms": 4, "area_m2": 41.1, "floors": 1, "doors": 3},
    "configuration": {"system.mode": "full"},
    "warnings": [f"warning {i}" for i in range(7)],
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """What a run of two rooms and a corridor leaves, a store room seen through a door."""
    truth = building()
    graph = SceneGraph.from_map(*perfect_map(truth, camera_poses(truth)))
    graph.rooms[1].partial = True
    out = tmp_path / "results"
    out.mkdir()
    (out / "scene_graph.json").write_text(format_scene_graph(graph))
    (out / "run.json").write_text(json.dumps(RUN))
    (out / "trajectory.txt").write_text("x" * 1500)
    (out / "notes.txt").write_text("mine")
    return out


def test_for_people(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    show_run(folder, as_json=False)
    text = capsys.readouterr().out
    lines = text.splitlines()
    assert lines[0].startswith(f"{folder}: run of house (TUM RGB-D), ended 2026-05-04 ")
    assert lines[1] == "made by vsgraphs 0.1.0, commit abc, mode full"
    assert lines[2] == "tracked 594 of 600 frames (99.0 %): 80 keyframes, 2 loops, 1 map"
    assert lines[3] == "found 4 rooms, 3 doors, 16 walls, 1 floor, 41 m2"
    words = {line.split()[0]: line.split()[1:] for line in lines if line}
    assert words["A"] == ["12.0", "m2", "4", "C"]
    assert words["B"] == ["11.6", "m2", "4", "C,", "S;", "partly", "seen"]
    assert "7 warnings:\n  warning 0\n" in text
    assert "  warning 4\n  and 2 more in run.json\n" in text
    assert words["trajectory.txt"] == ["1.5", "kB"]
    assert lines[-1].startswith("notes.txt")


def test_as_json(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    show_run(folder, as_json=True)
    info = json.loads(capsys.readouterr().out)
    assert info["complete"] is True
    assert (info["tracked"], info["mode"], info["ended"]) == (594, "full", RUN["ended"])
    assert [room["name"] for room in info["rooms"]] == ["A", "B", "C", "S"]
    assert [door["to"] for door in info["rooms"][2]["doors"]] == ["A", "B"]
    assert len(info["warnings"]) == 7
    assert info["files"]["trajectory.txt"] == 1500


def test_runs_of_older_versions_and_without_planes(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "scene_graph.json").unlink()
    old = {key: value for key, value in RUN.items() if key != "ended"} | {"scene": {}, "warnings": []}
    (folder / "run.json").write_text(json.dumps(old))
    show_run(folder, as_json=False)
    text = capsys.readouterr().out
    assert "found no walls, no rooms" in text
    assert "warning" not in text
    assert describe_run(folder)["rooms"] is None
    assert describe_run(folder)["ended"].startswith("20")


def test_a_run_that_was_killed(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for path in folder.iterdir():
        path.unlink()
    (folder / "atlas.vsg").write_bytes(b"map")
    show_run(folder, as_json=False)
    text = capsys.readouterr().out
    assert text.startswith(
        f"{folder}: no run.json: the run was killed, or it has not ended yet; `vsgraphs info "
    )
    assert "atlas.vsg" in text.splitlines()[-1]
    assert describe_run(folder)["complete"] is False


def test_directories_that_hold_no_run(
    folder: Path, tmp_path: Path, recorded: Path, vsgraphs: Program
) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "letter.txt").touch()
    assert "empty is empty" in one_line_error(vsgraphs("info", tmp_path / "empty"))
    assert "other holds no run: none of floorplan.svg" in one_line_error(vsgraphs("info", tmp_path / "other"))
    assert "slide is a TUM RGB-D sequence" in one_line_error(vsgraphs("info", recorded))
    (folder / "run.json").write_text('{"frames": 3')
    assert "run.json:1: not valid JSON" in one_line_error(vsgraphs("info", folder))
    for content in ([], {"frames": 3}, {**RUN, "warnings": None}):
        (folder / "run.json").write_text(json.dumps(content))
        with pytest.raises(InputError, match=r"run\.json: not the run\.json of a vsgraphs run"):
            describe_run(folder)


def test_a_run_s_own_directory(recorded: Path, tmp_path: Path, vsgraphs: Program) -> None:
    out = tmp_path / "o"
    assert vsgraphs("run", recorded, "--out", out, "--max-frames", 4).returncode == 0
    done = vsgraphs("info", out)
    assert done.returncode == 0, done.stderr
    assert "tracked 4 of 4 frames (100.0 %)" in done.stdout
    assert done.stdout.splitlines()[0].startswith(f"{out}: run of slide (TUM RGB-D), ended 20")
    info = json.loads(vsgraphs("info", out, "--json").stdout)
    assert info["source"]["path"] == str(recorded.resolve())
    # A single wall seen head-on: which way is up is not known, and that is told.
    assert any("which way is up cannot be told" in line for line in info["warnings"])
