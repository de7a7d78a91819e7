"""The viewer: what is drawn (without Rerun), and what reaches it (where Rerun is installed)."""

from __future__ import annotations

import threading
import time
from itertools import pairwise
from pathlib import Path
from typing import Any

import fake_core
import numpy as np
import pytest
from layouts import Scene, write_tum
from scene_worlds import building, camera_poses, perfect_map

from vsgraphs.cli.viewing import view_run
from vsgraphs.datasets import Calibration
from vsgraphs.errors import InputError
from vsgraphs.lens import depth_metres, distort
from vsgraphs.run.watching import RunView, Showing
from vsgraphs.scene_graph import SceneGraph, format_scene_graph
from vsgraphs.view.camera import back_project, landmarks_in_view, pixel_rays
from vsgraphs.view.layers import MAX_LINKED_KEYFRAMES, layered_graph, wall_heading
from vsgraphs.view.layout import gaze_at
from vsgraphs.view.surfaces import door_outline, plane_mesh, room_mesh, room_place, triangulate, upright

CAMERA = Calibration(64, 48, 60.0, 60.0, 31.5, 23.5, (0.2, -0.5, 0.001, -0.002, 0.3), depth_scale=1000.0)


def two_room_graph() -> SceneGraph:
    truth = building()
    return SceneGraph.from_map(*perfect_map(truth, camera_poses(truth)))


def area(points: np.ndarray, triangles: np.ndarray) -> float:
    a, b, c = (points[triangles[:, k]] for k in range(3))
    u, v = b - a, c - a
    return 0.5 * float(np.sum(np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])))


@pytest.mark.parametrize("turned", [1, -1])
def test_an_l_is_cut_into_triangles_within_it(turned: int) -> None:
    corners = np.array([[0, 0], [4, 0], [4, 1], [1, 1], [1, 3], [0, 3]], float)[::turned]
    triangles = triangulate(corners)
    assert len(triangles) == 4
    assert area(corners, triangles) == pytest.approx(6.0)  # overlaps or pieces outside would make it more
    assert triangulate(corners[:2]).shape == (0, 3)


def test_a_polygon_that_crosses_itself_ends_all_the_same() -> None:
    assert len(triangulate(np.array([[0, 0], [1, 1], [1, 0], [0, 1]], float))) == 2


def test_layers_stand_above_the_map_and_above_each_other() -> None:
    graph = two_room_graph()
    layered = layered_graph(graph, upright(graph))
    heights = [layered.layers[kind].places[:, 2] for kind in ("keyframe", "plane", "room", "floor")]
    top = max(plane.extent.polygon[:, 2].max() for plane in graph.planes_of("wall"))
    assert top < heights[0].min()
    for lower, upper in pairwise(heights):
        assert lower.max() < upper.min()
    rooms = list(graph.rooms.values())
    np.testing.assert_allclose(layered.layers["room"].places[:, :2], [room.centroid[:2] for room in rooms])
    assert layered.layers["room"].names == [room.name for room in rooms]


def test_edges_join_the_nodes_they_name() -> None:
    graph = two_room_graph()
    layered = layered_graph(graph, upright(graph))
    bounding = [edge for edge in graph.edges if edge.kind == "bounds"]
    ends = layered.edges["bounds"]
    assert len(ends) == len(bounding) > 0
    walls = {tuple(place) for place in layered.layers["plane"].places}
    rooms = {tuple(place) for place in layered.layers["room"].places}
    assert all(tuple(a) in walls and tuple(b) in rooms for a, b in ends)
    assert len(layered.edges["door"]) == sum(edge.kind == "door" for edge in graph.edges) > 0
    assert len(layered.stilts) == len(graph.rooms)


def test_few_keyframes_are_linked_of_many() -> None:
    graph = two_room_graph()
    some = next(iter(graph.keyframes.values()))
    edge = next(edge for edge in graph.edges if edge.kind == "observes_plane")
    graph.keyframes = {i: type(some)(i, float(i), some.world_from_camera) for i in range(500)}
    graph.edges = [type(edge)(edge.kind, f"keyframe:{i}", edge.target, edge.factor) for i in range(500)]
    assert 10 < len(layered_graph(graph, upright(graph)).edges["observes_plane"]) <= MAX_LINKED_KEYFRAMES


def test_an_empty_map_is_drawn_too() -> None:
    graph = SceneGraph()
    layered = layered_graph(graph, upright(graph))
    assert all(len(layer.places) == 0 for layer in layered.layers.values())
    assert np.isfinite(gaze_at(graph, upright(graph)).size).all()
    assert wall_heading(graph, np.eye(4)) == 0.0
    assert plane_mesh([], np.eye(4)).triangles.shape == (0, 3)


def test_a_map_that_is_not_levelled_hangs_on_its_camera() -> None:
    graph = SceneGraph()
    turned = upright(graph)[:3, :3]
    np.testing.assert_array_equal(turned @ [0, 0, 1], [1, 0, 0])  # the camera's viewing direction
    np.testing.assert_array_equal(turned @ [0, 1, 0], [0, 0, -1])  # its down
    assert np.linalg.det(turned) == pytest.approx(1.0)


def test_planes_rooms_and_doors_become_shapes_of_their_size() -> None:
    graph = two_room_graph()
    up = upright(graph)
    wall = graph.planes_of("wall")[0]
    mesh = plane_mesh([wall], up)
    u, v, w = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    assert 0.5 * np.linalg.norm(np.cross(v - u, w - u), axis=1).sum() == pytest.approx(wall.area_m2)
    rooms = list(graph.rooms.values())
    floor = room_mesh(rooms, up)
    assert area(floor.vertices, floor.triangles) == pytest.approx(
        sum(room.area_m2 for room in rooms), rel=0.01
    )
    for room in rooms:
        assert graph.room_at(room_place(room, up)) is room
    door = next(iter(graph.doors.values()))
    outline = door_outline(door, up)
    assert np.linalg.norm(outline[1] - outline[0]) == pytest.approx(door.width_m)
    np.testing.assert_allclose(outline[:2].mean(axis=0), door.center)


def test_rays_undo_the_lens() -> None:
    rays = pixel_rays(CAMERA, 4)
    u, v = distort(CAMERA, rays[..., 0], rays[..., 1])
    np.testing.assert_allclose(u[0], np.arange(0, 64, 4), atol=1e-3)
    np.testing.assert_allclose(v[:, 0], np.arange(0, 48, 4), atol=1e-3)


def test_landmarks_are_seen_where_depth_agrees() -> None:
    depth = np.full((48, 64), 2000, np.uint16)
    depth[:, 32:] = 65535  # none
    metres = depth_metres(depth, CAMERA)
    assert (metres[0, 0], metres[0, 40]) == (2.0, 0.0)
    points = np.array([[-0.3, 0.1, 2.0], [-0.3, 0.1, 3.0], [0.3, 0.1, 2.0], [0, 0, -2.0], [9, 0, 2.0]])
    pixels, index = landmarks_in_view(CAMERA, metres, np.eye(4), points)
    assert index.tolist() == [0]  # the others: hidden, without depth, behind the camera, outside the image
    np.testing.assert_allclose(pixels[0], np.squeeze(distort(CAMERA, *(points[:1, :2].T / 2.0))))
    seen, known = back_project(pixel_rays(CAMERA, 4), metres, 4)
    assert len(seen) == np.count_nonzero(known) == 12 * 8
    assert (seen[:, 2] == 2.0).all()


def test_float_depth_is_in_metres_already() -> None:
    depth = np.array([[1.5, np.nan, np.inf]], np.float32)
    np.testing.assert_array_equal(depth_metres(depth, CAMERA), [[1.5, 0, 0]])


# --- what goes wrong


def test_without_the_extra_one_line_names_it(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(__import__("sys").modules, "rerun", None)
    for showing in (Showing(view=True), Showing(web=True), Showing(record=tmp_path / "a.rrd")):
        with pytest.raises(InputError, match=r"^the viewer is not installed; pip install 'vsgraphs\[viz\]'$"):
            RunView(showing)
    RunView(Showing()).close()  # nothing wanted, nothing needed


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda p: None, "nothing does not exist; give the directory"),
        (lambda p: p.write_text("x"), "nothing is a file; give the directory"),
        (lambda p: p.mkdir(), r"holds no run: none of scene_graph\.json, map\.ply, trajectory\.txt"),
    ],
)
def test_view_of_what_is_no_run(tmp_path: Path, make: Any, message: str) -> None:
    make(tmp_path / "nothing")
    with pytest.raises(InputError, match=message):
        view_run(tmp_path / "nothing", Showing(view=True))


# --- with Rerun


def rerun_or_skip() -> Any:
    return pytest.importorskip("rerun", reason="the extra viz is not installed")


class SlamWithMap(fake_core.Slam):
    """Knows a version of its map."""

    @property
    def version(self) -> int:
        return self.seen


class Posed:
    world_from_camera: np.ndarray | None = np.eye(4)


def shown_paths(recording: Path) -> set[str]:
    import pyarrow  # noqa: F401  (comes with Rerun)

    data = recording.read_bytes()
    names = ("world/path", "world/landmarks", "world/camera/image", "world/camera/depth", "world/rooms/areas")
    return {name for name in names if f"/{name}".encode() in data}


def live_view(record: Path, told: list[str]) -> Any:
    from vsgraphs.view import LiveView, SinkRequest, open_sinks

    opened = open_sinks(SinkRequest(record=record), told.append)
    return LiveView(SlamWithMap(), CAMERA, opened, with_planes=False, tell=told.append)


def test_a_run_is_recorded_and_every_frame_accounted_for(tmp_path: Path) -> None:
    rerun_or_skip()
    told: list[str] = []
    view = live_view(tmp_path / "run.rrd", told)
    scene = Scene()
    for index in range(8):
        view.offer(np.ascontiguousarray(scene.rgb(index)), scene.depth(index), 0.1 * index, Posed())
        time.sleep(0.05)
    view.close()
    report = view.report()
    assert told == view.warnings == []
    assert report["shown"] + report["dropped"] == 8
    assert report["shown"] >= 1
    assert {"world/path", "world/camera/image", "world/camera/depth"} <= shown_paths(tmp_path / "run.rrd")


def test_the_newest_frame_wins_and_offering_never_waits(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rerun_or_skip()
    from vsgraphs.view import live

    seen: list[float] = []
    begun, gate = threading.Event(), threading.Event()

    def slow(self: Any, shot: Any) -> None:
        begun.set()
        gate.wait(60)
        seen.append(shot.timestamp_s)

    monkeypatch.setattr(live.LiveView, "_show", slow)
    view = live_view(tmp_path / "run.rrd", [])
    image = np.zeros((48, 64, 3), np.uint8)
    view.offer(image, image[..., 0], 0.0, Posed())
    assert begun.wait(60)  # the thread now waits at the gate with frame 0
    for index in range(1, 100):
        view.offer(image, image[..., 0], float(index), Posed())
    gate.set()
    while len(seen) < 2:
        time.sleep(0.01)
    view.close()
    assert seen == [0.0, 99.0]
    assert view.report()["dropped"] == 98


def test_a_viewer_that_fails_costs_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rerun_or_skip()
    from vsgraphs.view import live

    def broken(self: Any, shot: Any) -> None:
        raise RuntimeError("no more")

    monkeypatch.setattr(live.LiveView, "_show", broken)
    told: list[str] = []
    view = live_view(tmp_path / "run.rrd", told)
    image = np.zeros((48, 64, 3), np.uint8)
    for index in range(5):
        view.offer(image, image[..., 0], float(index), Posed())
        time.sleep(0.05)
    view.close()
    assert told == ["warning: the viewer failed, the run goes on without it: RuntimeError: no more"]
    assert view.warnings == ["the viewer failed, the run goes on without it: RuntimeError: no more"]
    assert view.report()["shown"] == 0


@pytest.mark.parametrize(
    ("name", "message"),
    [("a.txt", "expected a name ending in .rrd"), ("missing/a.rrd", "missing is not a directory")],
)
def test_record_where_nothing_can_be_written(tmp_path: Path, name: str, message: str) -> None:
    rerun_or_skip()
    with pytest.raises(InputError, match=message):
        RunView(Showing(record=tmp_path / name))


def test_a_finished_run_is_shown_from_its_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rerun_or_skip()
    run = tmp_path / "results"
    run.mkdir()
    graph = two_room_graph()
    (run / "scene_graph.json").write_text(format_scene_graph(graph))
    write_tum(tmp_path / "desk")
    (run / "trajectory.txt").write_text((tmp_path / "desk/groundtruth.txt").read_text())
    view_run(run, Showing(record=tmp_path / "run.rrd"))
    assert "recorded in" in capsys.readouterr().out
    data = (tmp_path / "run.rrd").read_bytes()
    for name in ("world/rooms/areas", "world/graph/edges/bounds", "world/path"):
        assert name.encode() in data
    (run / "scene_graph.json").write_text("{")
    with pytest.raises(InputError, match=r"scene_graph\.json: not a whole JSON file"):
        view_run(run, Showing(record=tmp_path / "again.rrd"))
