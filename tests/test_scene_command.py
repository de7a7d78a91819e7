from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Program, one_line_error
from scene_worlds import building, camera_poses, perfect_map

from vsgraphs.errors import InputError
from vsgraphs.export.ply import format_ply, read_ply
from vsgraphs.scene_graph import SceneGraph, format_scene_graph
from vsgraphs.trajectory import Array, format_tum


@pytest.fixture
def run_folder(tmp_path: Path) -> Path:
    """What a flawless run leaves: out/ beside scene/."""
    truth = building()
    poses = camera_poses(truth)
    raw, keyframes = perfect_map(truth, poses)
    graph = SceneGraph.from_map(raw, keyframes)
    (tmp_path / "out").mkdir()
    (tmp_path / "scene").mkdir()
    (tmp_path / "out" / "scene_graph.json").write_text(format_scene_graph(graph))
    exported = graph.poses_from_map(keyframes[2])
    (tmp_path / "out" / "trajectory.txt").write_text(format_tum(keyframes[1], exported))
    points = graph.points_from_map(np.concatenate([plane["points"][::50] for plane in raw["planes"]]))
    (tmp_path / "out" / "map.ply").write_bytes(format_ply(points, np.zeros((len(points), 3), np.uint8)))
    (tmp_path / "scene" / "scene_gt.json").write_text(json.dumps(truth))
    (tmp_path / "scene" / "groundtruth.txt").write_text(format_tum(keyframes[1], poses))
    return tmp_path


def _flawless() -> tuple[tuple[Array, Array, Array], SceneGraph]:
    truth = building()
    raw, keyframes = perfect_map(truth, camera_poses(truth))
    return keyframes, SceneGraph.from_map(raw, keyframes)


def test_the_command(run_folder: Path, vsgraphs: Program) -> None:
    out, truth = run_folder / "out", run_folder / "scene" / "scene_gt.json"
    done = vsgraphs("eval", "--scene", out, "--truth", truth, "--json", run_folder / "s.json")
    assert done.returncode == 0, done.stderr
    assert "12 / 12" in done.stdout
    figures = json.loads((run_folder / "s.json").read_text())
    walls = figures["building_components"]["walls"]
    assert (walls["detected"], walls["true"], walls["precision"], walls["recall"]) == (12, 12, 1.0, 1.0)
    assert figures["structural_elements"]["doors"]["f1"] == 1.0
    assert figures["map"]["share_within"] == 1.0
    assert figures["map"]["rmse_m"] < 1e-4
    assert figures["ate_rmse_m"] < 1e-6
    # In the map's own frame trajectory and map give the same figures: the keyframes say which frame it is.
    keyframes, graph = _flawless()
    (out / "trajectory.txt").write_text(format_tum(keyframes[1], keyframes[2]))
    in_graph, colours = read_ply(out / "map.ply")
    to_graph = graph.frame.world_from_map
    in_map = (in_graph - to_graph[:3, 3]) @ to_graph[:3, :3]
    (out / "map.ply").write_bytes(format_ply(in_map, colours))
    done = vsgraphs("eval", "--scene", out, "--truth", truth, "--json", run_folder / "s.json")
    assert done.returncode == 0, done.stderr
    again = json.loads((run_folder / "s.json").read_text())
    assert again["building_components"]["walls"]["detected"] == 12
    assert again["map"]["rmse_m"] < 1e-4
    (out / "map.ply").unlink()
    done = vsgraphs("eval", "--scene", out, "--truth", truth, "--tolerance", "angle_deg=5")
    assert "map points are not scored" in done.stdout


def test_a_run_s_directory_is_compared_as_a_whole(run_folder: Path, vsgraphs: Program) -> None:
    out, scene = run_folder / "out", run_folder / "scene"
    for truth in (scene, scene / "groundtruth.txt"):
        done = vsgraphs("eval", out, "--groundtruth", truth, "--json", run_folder / "e.json")
        assert done.returncode == 0, done.stderr
        rows = {line.split()[0]: line.split()[1:] for line in done.stdout.splitlines() if line.strip()}
        assert rows["rooms"][:4] == ["3", "of", "3", "0"]
        assert rows["rooms'"][:5] == ["walls", "12", "of", "12", "0"]
        assert rows["camera"][:3] == ["ATE", "0.00", "cm"]  # completion unknown: there is no run.json
        figures = json.loads((run_folder / "e.json").read_text())
        assert figures["ate"]["rmse_m"] < 1e-6
        assert figures["scene"]["structural_elements"]["rooms"]["detected"] == 3
    # The run knows what it was made from.
    (out / "run.json").write_text(json.dumps({"completion": 0.5, "source": {"path": str(scene)}}))
    done = vsgraphs("eval", out)
    assert re.search(r"camera +50\.0 % +ATE 0\.00 cm", done.stdout)
    (out / "run.json").write_text(json.dumps({"source": {"path": str(run_folder / "gone")}}))
    assert "gone, which the run was made from, is gone" in one_line_error(vsgraphs("eval", out))


def test_a_scene_graph_that_cannot_be_compared_leaves_the_trajectory(
    run_folder: Path, vsgraphs: Program
) -> None:
    graph = run_folder / "out" / "scene_graph.json"
    graph.write_text(graph.read_text()[:300])
    done = vsgraphs("eval", run_folder / "out", "--groundtruth", run_folder / "scene")
    assert done.returncode == 0, done.stderr
    assert "note: the scene graph is not compared: " in done.stdout
    assert "ATE" in done.stdout
    assert "rooms" not in done.stdout


def test_mistakes_are_one_line(run_folder: Path, vsgraphs: Program) -> None:
    out, truth = run_folder / "out", run_folder / "scene" / "scene_gt.json"
    lonely = run_folder / "scene_gt.json"
    lonely.write_text(truth.read_text())
    no_truth = run_folder / "broken.json"
    no_truth.write_text('{"rooms": [{"id": 1}], "walls": []}')
    gt = ["--groundtruth", run_folder / "scene" / "groundtruth.txt"]
    cases: list[tuple[list[Any], str]] = [
        (["--scene", out], "--truth scene_gt.json is missing"),
        (["--truth", truth], "--scene RUN_DIR is missing"),
        (["--scene", out, "--truth", lonely], "no groundtruth.txt beside"),
        (["--scene", run_folder, "--truth", truth], "cannot read scene graph"),
        (["--scene", out, "--truth", run_folder / "none.json", *gt], "cannot read scene truth"),
        (["--scene", out, "--truth", out / "scene_graph.json", *gt], "not a scene truth"),
        (["--scene", out, "--truth", no_truth, *gt], "broken scene truth: no 'polygon'"),
        (["--scene", out, "--truth", truth, "--tolerance", "x=1"], "unknown tolerance"),
        (["--scene", out, "--truth", truth, "--plot", "p.png"], "leave it out"),
        ([], "missing --groundtruth"),
    ]
    for arguments, message in cases:
        assert message in one_line_error(vsgraphs("eval", *arguments)), arguments
    (out / "map.ply").write_bytes((out / "map.ply").read_bytes()[:-7])
    assert "points are there" in one_line_error(vsgraphs("eval", "--scene", out, "--truth", truth))


def test_ply_is_read_back(tmp_path: Path) -> None:
    points, colours = np.array([[1.5, -2.0, 0.25]]), np.array([[1, 2, 3]], np.uint8)
    path = tmp_path / "map.ply"
    path.write_bytes(format_ply(points, colours))
    found = read_ply(path)
    np.testing.assert_array_equal(found[0], points)
    np.testing.assert_array_equal(found[1], colours)
    path.write_text("ply\nformat ascii 1.0\n")
    with pytest.raises(InputError, match="not a point cloud"):
        read_ply(path)
