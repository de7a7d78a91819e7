from __future__ import annotations

import copy
import json
import sys
from typing import Any

import numpy as np
import pytest
from scene_worlds import building, camera_poses, perfect_map

from vsgraphs.errors import InputError
from vsgraphs.scene_graph import (
    SceneGraph,
    extent_of,
    format_scene_graph,
    parse_scene_graph,
    relations,
)
from vsgraphs.scene_graph.extent import convex_hull
from vsgraphs.scene_graph.kinds import KINDS
from vsgraphs.trajectory import Array

Raw = dict[str, Any]
Keyframes = tuple[Array, Array, Array]


@pytest.fixture
def snapshot() -> tuple[Raw, Keyframes]:
    truth = building()
    return perfect_map(truth, camera_poses(truth))


@pytest.fixture
def graph(snapshot: tuple[Raw, Keyframes]) -> SceneGraph:
    return SceneGraph.from_map(*snapshot)


# ---- levelling


def test_levelled_z_up_ground_at_zero_x_forward(graph: SceneGraph) -> None:
    frame = graph.frame
    assert frame.levelled
    assert frame.ground == 16
    assert frame.zero_height == "ground plane 16"
    np.testing.assert_allclose(graph.planes[16].normal, [0, 0, 1], atol=1e-9)
    assert graph.planes[16].offset_m == pytest.approx(0, abs=1e-9)
    first = graph.keyframes[0].world_from_camera
    np.testing.assert_allclose(first[:3, 3], [0, 0, 1.3], atol=1e-9)
    assert first[1, 2] == pytest.approx(0, abs=1e-9)  # it looks along x, up or down
    assert first[0, 2] > 0.9
    rotation = frame.world_from_map[:3, :3]
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(rotation) == pytest.approx(1)
    for plane in graph.planes.values():
        assert float(plane.normal @ plane.centroid + plane.offset_m) == pytest.approx(0, abs=1e-6)
    for room in graph.rooms.values():
        np.testing.assert_allclose(room.polygon[:, 2], 0, atol=1e-9)


def test_the_same_transform_moves_everything(snapshot: tuple[Raw, Keyframes], graph: SceneGraph) -> None:
    raw, (_, _, poses) = snapshot
    moved = graph.poses_from_map(poses)
    for keyframe, pose in zip(graph.keyframes.values(), moved, strict=True):
        np.testing.assert_array_equal(keyframe.world_from_camera, pose)
    points = graph.points_from_map(raw["planes"][16]["points"])
    np.testing.assert_allclose(points[:, 2], 0, atol=1e-6)
    assert graph.poses_from_map(np.zeros((0, 4, 4))).shape == (0, 4, 4)


def test_without_up_the_graph_stays_in_the_map(snapshot: tuple[Raw, Keyframes]) -> None:
    raw, keyframes = snapshot
    graph = SceneGraph.from_map({**raw, "up": None}, keyframes)
    assert not graph.frame.levelled
    np.testing.assert_array_equal(graph.frame.world_from_map, np.eye(4))
    np.testing.assert_allclose(graph.planes[3].normal, raw["planes"][3]["normal"])
    assert "not levelled" in graph.frame.zero_height
    document = json.loads(format_scene_graph(graph))
    assert document["frame"]["levelled"] is False
    with pytest.raises(InputError, match="not levelled"):
        graph.room_at(np.zeros(3))


def test_without_a_ground_zero_is_the_first_camera(snapshot: tuple[Raw, Keyframes]) -> None:
    raw, keyframes = snapshot
    raw["planes"] = [plane for plane in raw["planes"] if plane["role"] == "wall"]
    graph = SceneGraph.from_map({"up": raw["up"], "planes": raw["planes"]}, keyframes)
    assert graph.frame.levelled
    assert graph.frame.ground is None
    assert graph.frame.zero_height == "the first camera's height"
    np.testing.assert_allclose(graph.keyframes[0].world_from_camera[:3, 3], 0, atol=1e-9)


def test_the_most_observed_ground_near_the_camera_is_zero(snapshot: tuple[Raw, Keyframes]) -> None:
    raw, keyframes = snapshot
    floor = raw["planes"][16]

    def other(number: int, lower: float, away: float, seen: int) -> Raw:
        plane = copy.deepcopy(floor)
        shift = -lower * raw["up"] + away * np.array([1.0, 0, 0])
        plane["id"], plane["observed_by"] = number, list(range(seen))
        plane["d"] = floor["d"] + lower
        plane["points"] = plane["points"] + shift
        return plane

    raw["planes"] += [other(30, 0.4, 0.0, 2), other(31, 2.8, 50.0, 12), other(32, -0.7, 0.0, 3)]
    raw["planes"][16]["observed_by"] = [0, 1, 2, 3, 4]
    assert SceneGraph.from_map(raw, keyframes).frame.ground == 16
    raw["planes"][-3]["observed_by"] = list(range(9))
    assert SceneGraph.from_map(raw, keyframes).frame.ground == 30


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_a_first_camera_that_looks_straight_up_or_down(direction: float) -> None:
    up = np.array([0, 0, direction])  # in the map z is where the first camera looks
    graph = SceneGraph.from_map({"up": up, "planes": []}, (np.array([0]), np.zeros(1), np.eye(4)[None]))
    camera = graph.keyframes[0].world_from_camera[:3, :3]
    np.testing.assert_allclose(camera[:, 2], [0, 0, direction], atol=1e-12)
    np.testing.assert_allclose(camera[:, 1], [direction, 0, 0], atol=1e-12)  # the image's top or bottom


def test_an_empty_map() -> None:
    nothing = (np.zeros(0, np.uint32), np.zeros(0), np.zeros((0, 4, 4)))
    graph = SceneGraph.from_map({"up": None, "planes": []}, nothing)
    assert graph.estimated == {"keyframes", "planes"}
    assert parse_scene_graph(json.loads(format_scene_graph(graph)), "x").keyframes == {}


# ---- nodes and edges


def plain_hull(uv: np.ndarray) -> np.ndarray:
    """Andrew's monotone chain, over all points."""
    points = [(float(u), float(v)) for u, v in np.unique(np.round(uv, 3), axis=0)]
    if len(points) < 3:
        return np.array(points)
    halves = []
    for ordered in (points, points[::-1]):
        chain: list[tuple[float, float]] = []
        for u, v in ordered:
            while len(chain) > 1:
                (u0, v0), (u1, v1) = chain[-2:]
                if (u1 - u0) * (v - v0) - (v1 - v0) * (u - u0) > 1e-9:
                    break
                chain.pop()
            chain.append((u, v))
        halves += chain[:-1]
    return np.array(halves)


def test_hulls_are_those_of_all_points() -> None:
    rng = np.random.default_rng(5)
    shapes = [
        rng.normal(size=(400, 2)),
        rng.integers(-5, 6, size=(300, 2)) * 0.1,  # many on the edges
        rng.uniform(-1, 1, size=(300, 2)) * [10, 0.003] + 100,  # a strip
        np.repeat(rng.normal(size=(50, 1)), 2, axis=1),  # a line
        np.ones((7, 2)),
    ]
    for points in [*shapes, *(shapes[0][:n] for n in range(1, 20))]:
        np.testing.assert_array_equal(convex_hull(points), plain_hull(points))


def test_extents_leave_doorways_out(graph: SceneGraph) -> None:
    whole, with_door = graph.planes[0], graph.planes[2]
    assert whole.area_m2 == pytest.approx(4.0 * 2.6, rel=0.03)
    assert with_door.area_m2 == pytest.approx(4.0 * 2.6 - 0.9 * 2.05, rel=0.07)
    np.testing.assert_allclose(whole.centroid, graph.points_from_map(_map_point([2.0, 0, 1.3])), atol=0.06)
    hull = whole.extent.flat(whole.extent.polygon)
    assert len(hull) < 30
    assert np.ptp(hull, axis=0) == pytest.approx([3.95, 2.55], abs=0.01)
    np.testing.assert_allclose(whole.extent.axis_v, [0, 0, 1], atol=1e-9)
    np.testing.assert_allclose(np.cross(whole.extent.axis_u, whole.extent.axis_v), whole.normal, atol=1e-9)


def _map_point(point: list[float]) -> Array:
    first = np.linalg.inv(camera_poses(building())[0])
    return (first @ [*point, 1.0])[:3]


def test_thinned_points_leave_no_holes() -> None:
    rng = np.random.default_rng(0)
    points = np.stack([rng.uniform(0, 6, 2500), rng.uniform(0, 2.5, 2500), np.full(2500, 2.0)], axis=1)
    extent = extent_of(points, np.array([0.0, 0, 1]), -2.0, np.array([0.0, 1, 0]))
    assert extent.area_m2 == pytest.approx(15.0, rel=0.02)
    assert len(extent.cells()) == round(extent.area_m2 / 0.01)
    np.testing.assert_allclose(extent.cell_centres()[:, 2], 2.0)
    gap = points[(points[:, 0] < 2.5) | (points[:, 0] > 3.5)]
    assert extent_of(gap, np.array([0.0, 0, 1]), -2.0, np.array([0.0, 1, 0])).area_m2 < 13.0


def test_convex_hull() -> None:
    grid = np.array([[x, y] for x in range(5) for y in range(4)], float)
    np.testing.assert_array_equal(convex_hull(grid), [[0, 0], [4, 0], [4, 3], [0, 3]])
    ring = np.stack([np.cos(np.arange(12) * np.pi / 6), np.sin(np.arange(12) * np.pi / 6)], axis=1)
    assert len(convex_hull(np.concatenate([ring, ring * 0.5]))) == 12
    assert len(convex_hull(np.array([[0.0, 0], [1, 1]]))) == 2


def test_edges_and_their_factors(graph: SceneGraph) -> None:
    kinds = {kind: [e for e in graph.edges if e.kind == kind] for kind in relations()}
    observed = sum(len(plane.observed_by) for plane in graph.planes.values())
    assert len(kinds["observes_plane"]) == observed
    assert len(kinds["bounds"]) == 16
    assert {e.factor for e in kinds["bounds"]} == {"room_centroid"}
    assert len(kinds["wall_perpendicular_to_ground"]) == 16
    assert [(e.source, e.target, e.via) for e in kinds["door"]] == [
        ("room:0", "room:2", "door:0"),
        ("room:1", "room:2", "door:1"),
        ("room:1", "room:3", "door:2"),
    ]
    assert kinds["door"][0].factor is None
    assert len(kinds["belongs_to"]) == len(kinds["ground_of"]) == 4
    assert [(e.source, e.target) for e in kinds["names"]] == [("marker:17", "room:0")]
    assert len(kinds["observes_marker"]) == 2
    assert all(edge.factor == relations()[edge.kind].factor for edge in graph.edges)


def test_wall_pairs_and_faces(snapshot: tuple[Raw, Keyframes]) -> None:
    raw, keyframes = snapshot
    raw["wall_pairs"] = [
        {"planes": [2, 0], "relation": "parallel"},
        {"planes": [0, 1], "relation": "perpendicular"},
        {"planes": [1, 16], "relation": "wall_perpendicular_to_ground"},
    ]
    raw["planes"][1]["other_face"], raw["planes"][7]["other_face"] = 7, 1
    raw["planes"][1]["thickness_m"] = raw["planes"][7]["thickness_m"] = 0.12
    graph = SceneGraph.from_map(raw, keyframes)
    found = {(e.kind, e.source, e.target) for e in graph.edges}
    assert ("parallel", "plane:0", "plane:2") in found
    assert ("perpendicular", "plane:0", "plane:1") in found
    faces = [e for e in graph.edges if e.kind == "other_face"]
    assert [(e.source, e.target) for e in faces] == [("plane:1", "plane:7")]
    assert graph.planes[7].thickness_m == 0.12
    raw["planes"][2]["thickness_m"] = 0.0  # as the core has it where no other face is known
    assert SceneGraph.from_map(raw, keyframes).planes[2].thickness_m is None


def test_walls_alone_are_enough(snapshot: tuple[Raw, Keyframes]) -> None:
    raw, keyframes = snapshot
    graph = SceneGraph.from_map({"up": raw["up"], "planes": raw["planes"]}, keyframes)
    assert graph.estimated == {"keyframes", "planes"}
    document = json.loads(format_scene_graph(graph))
    assert "rooms" not in document
    assert {edge["kind"] for edge in document["edges"]} == {"observes_plane"}


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (lambda raw: raw["planes"][2].update(normal=np.array([np.nan, 0, 1])), "plane 2: normal: not finite"),
        (lambda raw: raw["planes"][2].update(normal=np.array([0.0, 0, 2])), "length 2, expected 1"),
        (lambda raw: raw["planes"][2].update(role="roof"), "unknown role 'roof'"),
        (lambda raw: raw["rooms"][1]["walls"].append(77), "room 1 names plane 77, which is not there"),
        (lambda raw: raw["doors"][0].update(rooms=[0, 9]), "door 0 names room 9"),
    ],
)
def test_broken_maps_are_refused(snapshot: tuple[Raw, Keyframes], damage: Any, message: str) -> None:
    raw, keyframes = snapshot
    damage(raw)
    with pytest.raises(InputError, match=message):
        SceneGraph.from_map(raw, keyframes)


def test_keyframes_that_were_culled_are_left_out(snapshot: tuple[Raw, Keyframes]) -> None:
    raw, keyframes = snapshot
    raw["planes"][0]["observed_by"] = [0, 3, 500]
    assert SceneGraph.from_map(raw, keyframes).planes[0].observed_by == [0, 3]


# ---- queries


def test_rooms_at_points(graph: SceneGraph) -> None:
    for name in "ABC":
        room = graph.room(name)
        found = graph.room_at(room.centroid + np.array([0, 0, 1.2]))
        assert found is room
        assert graph.room_at(room.centroid + np.array([0, 0, 2.7])) is None
    assert graph.room_at(np.array([50.0, 0, 1])) is None


def test_paths_lead_through_doors(graph: SceneGraph) -> None:
    path = graph.path_between("A", "B")
    assert path is not None
    assert (path.rooms, path.doors) == ([0, 2, 1], [0, 1])
    to_door = np.hypot(0, 1.56)
    last = np.hypot(6.0 - 6.06, 1.56)
    assert path.length_m == pytest.approx(to_door + 4.0 + last)
    assert graph.path_between(0, 3).rooms == [0, 2, 1, 3]  # type: ignore[union-attr]
    same = graph.path_between("A", "A")
    assert same is not None
    assert (same.rooms, same.doors, same.length_m) == ([0], [], 0.0)
    assert graph.neighbours("B") == {2: [1], 3: [2]}
    del graph.doors[1]
    assert graph.path_between("A", "B") is None
    with pytest.raises(InputError, match="no room 'cellar' in the scene graph; its rooms: A, B, C, S"):
        graph.room("cellar")


def test_networkx(graph: SceneGraph, monkeypatch: pytest.MonkeyPatch) -> None:
    networkx = pytest.importorskip("networkx")
    out = graph.to_networkx()
    count = sum(len(graph.section(kind.section)) for kind in KINDS)
    assert out.number_of_nodes() == count
    assert out.nodes["plane:16"]["role"] == "ground"
    assert out.nodes["room:2"]["subtype"] == "corridor"
    doors = networkx.subgraph_view(out, filter_edge=lambda a, b, key: key.startswith("door"))
    assert networkx.shortest_path(doors, "room:0", "room:3") == ["room:0", "room:2", "room:1", "room:3"]
    assert out["plane:0"]["room:0"]["bounds"]["factor"] == "room_centroid"
    monkeypatch.setitem(sys.modules, "networkx", None)
    with pytest.raises(InputError, match=r"pip install 'vsgraphs\[graph\]'"):
        graph.to_networkx()
