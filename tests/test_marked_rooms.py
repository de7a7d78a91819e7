"""From a simulated walk past markers (plan `marked_rooms`) to named rooms."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import one_line_error, report

from vsgraphs import plans
from vsgraphs.evaluate import associate, umeyama
from vsgraphs.scene_graph import SceneGraph, load_scene_graph
from vsgraphs.simulate import Output, simulate
from vsgraphs.trajectory import Array, read_tum_trajectory

pytest.importorskip("cv2")

Program = Callable[..., subprocess.CompletedProcess[str]]
MARKERS = {
    "dictionary": "4x4_50",
    "size_m": 0.2,
    "markers": {
        "7": {"name": "kitchen", "kind": "room"},
        "12": {"name": "office", "kind": "room"},
        "3": {"name": "kitchen door", "kind": "door", "size_m": 0.16},
        "33": {"name": "cellar", "kind": "room"},
    },
}


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The first half of the walk at 10 frames per second."""
    plan = json.loads((Path(plans.__file__).parent / "marked_rooms.json").read_text())
    plan["path"]["waypoints"] = plan["path"]["waypoints"][:15]
    plan["path"]["closed"] = False
    folder = tmp_path_factory.mktemp("marked") / "walk"
    simulate(plan, folder, output=Output(fps=10, labels_every=0))
    return folder


def marker_file(folder: Path, content: dict[str, Any]) -> Path:
    file = folder / "markers.json"
    file.write_text(json.dumps(content))
    return file


def truth_from_graph(walk: Path, out: Path) -> Array:
    estimated, true = (
        read_tum_trajectory(out / "trajectory.txt"),
        read_tum_trajectory(walk / "groundtruth.txt"),
    )
    a, b = associate(estimated.timestamps, true.timestamps)
    return umeyama(estimated.poses[a, :3, 3], true.poses[b, :3, 3])


def room_named(graph: SceneGraph, name: str, transform: Array) -> Array:
    """Its middle in the truth."""
    middle: Array = transform[:3, :3] @ graph.room(name).centroid + transform[:3, 3]
    return middle


def test_markers_are_mapped_and_name_rooms_and_door(vsgraphs: Program, walk: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    # 20 hangs in the first room; the file says nothing of it but its size.
    file = marker_file(tmp_path, MARKERS)
    done = vsgraphs(
        *("run", walk, "--out", out, "--markers", file, "--execution", "serial"),
        *("--save-atlas", out / "atlas.vsg"),
    )
    assert done.returncode == 0, done.stderr
    graph, transform = load_scene_graph(out / "scene_graph.json"), truth_from_graph(walk, out)
    truth = {row["id"]: row for row in json.loads((walk / "scene_gt.json").read_text())["markers"]}
    assert {3, 7, 12} <= set(graph.markers)
    for number in (3, 7, 12):
        estimated = transform @ graph.markers[number].world_from_marker
        true = np.array(truth[number]["world_from_marker"])
        # 3 is small and was passed by: two keyframes see it.
        assert np.linalg.norm(estimated[:3, 3] - true[:3, 3]) < 0.02, number
        assert estimated[:3, 2] @ true[:3, 2] > np.cos(np.deg2rad(5)), number
    np.testing.assert_allclose(room_named(graph, "kitchen", transform)[:2], [2.5, 2.1], atol=0.4)
    np.testing.assert_allclose(room_named(graph, "office", transform)[:2], [7.5, 2.1], atol=0.6)
    assert [door.name for door in graph.doors.values() if door.name] == ["kitchen door"]
    assert ">kitchen<" in (out / "floorplan.svg").read_text()
    found = report(out)
    assert found["markers"]["dictionary"] == "4x4_50"
    assert found["markers"]["sights"] >= 6
    info = json.loads(vsgraphs("info", out / "atlas.vsg", "--json").stdout)
    assert info["markers"] == info["each"][0]["markers"] == len(graph.markers)
    assert found["warnings"][-1].endswith("these are not in the map: 33 ('cellar')")


def test_serial_runs_are_the_same_bytes_and_replays_follow(
    vsgraphs: Program, walk: Path, tmp_path: Path
) -> None:
    file = marker_file(tmp_path, MARKERS)
    options = ("--markers", file, "--max-frames", 60)
    schedule = tmp_path / "schedule.txt"
    for name in ("a", "b"):
        done = vsgraphs("run", walk, "--out", tmp_path / name, *options, "--execution", "serial")
        assert done.returncode == 0, done.stderr
    same = [(tmp_path / name / "scene_graph.json").read_bytes() for name in ("a", "b")]
    assert same[0] == same[1]
    assert b'"marker:7"' in same[0]
    assert (
        vsgraphs("run", walk, "--out", tmp_path / "c", *options, "--schedule-out", schedule).returncode == 0
    )
    assert "markers " in schedule.read_text()
    assert vsgraphs("run", walk, "--out", tmp_path / "d", *options, "--replay", schedule).returncode == 0
    recorded, replayed = ((tmp_path / name / "trajectory.txt").read_bytes() for name in ("c", "d"))
    assert recorded == replayed
    done = vsgraphs("run", walk, "--out", tmp_path / "e", "--max-frames", 60, "--replay", schedule)
    assert "give the same --markers" in one_line_error(done)


def test_a_wrong_size_is_told(vsgraphs: Program, walk: Path, tmp_path: Path) -> None:
    file = marker_file(tmp_path, {**MARKERS, "size_m": 0.1})
    out = tmp_path / "out"
    done = vsgraphs("run", walk, "--out", out, "--markers", file, "--max-frames", 40)
    assert done.returncode == 0, done.stderr
    assert any("by its depth marker 7 is" in line for line in report(out)["warnings"])
    assert 7 not in load_scene_graph(out / "scene_graph.json").markers


def test_mistakes_are_one_line(vsgraphs: Program, sequence: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = vsgraphs("run", sequence, "--out", out, "--markers", tmp_path / "none.json")
    assert "cannot read marker file" in one_line_error(done)
    file = marker_file(tmp_path, {**MARKERS, "dictionary": "4x4"})
    done = vsgraphs("run", sequence, "--out", out, "--markers", file)
    assert "unknown dictionary" in one_line_error(done)
    assert not out.exists()
