from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import spark_dsg
from scene_worlds import building, camera_poses, perfect_map

from vsgraphs.export.class_colours import class_colours, plane_of_points
from vsgraphs.export.floorplan import format_floorplan
from vsgraphs.export.planes_ply import format_planes_ply
from vsgraphs.export.spark_dsg import format_spark_dsg
from vsgraphs.scene_graph import CLASS_COLOURS, NO_PLANE, SceneGraph
from vsgraphs.trajectory import Array

Raw = dict[str, Any]


@pytest.fixture(scope="module")
def snapshot() -> tuple[Raw, tuple[Array, Array, Array]]:
    truth = building()
    return perfect_map(truth, camera_poses(truth))


@pytest.fixture(scope="module")
def graph(snapshot: Any) -> SceneGraph:
    return SceneGraph.from_map(*snapshot)


@pytest.fixture(scope="module")
def walls_only(snapshot: Any) -> SceneGraph:
    raw, keyframes = snapshot
    walls = [plane for plane in raw["planes"] if plane["role"] == "wall"]
    return SceneGraph.from_map({"up": raw["up"], "planes": walls}, keyframes)


def positions(graph: SceneGraph) -> Array:
    return np.array([keyframe.world_from_camera[:3, 3] for keyframe in graph.keyframes.values()])


# ---- planes.ply, coloured points


def test_planes_as_a_mesh(graph: SceneGraph) -> None:
    data = format_planes_ply(graph)
    header, _, body = data.partition(b"end_header\n")
    vertices, faces = (int(n) for n in re.findall(rb"element \w+ (\d+)", header))
    vertex = np.dtype([("xyz", "<f4", 3), ("normal", "<f4", 3), ("rgb", "u1", 3), ("plane", "<i4")])
    face = np.dtype([("count", "u1"), ("corners", "<i4", 4)])
    assert len(body) == vertices * vertex.itemsize + faces * face.itemsize
    points = np.frombuffer(body, vertex, vertices)
    quads = np.frombuffer(body, face, faces, vertices * vertex.itemsize)
    assert set(quads["count"]) == {4}
    assert quads["corners"].max() == vertices - 1
    on_wall = points["plane"] == 0
    assert (points["rgb"][on_wall] == CLASS_COLOURS["wall"]).all()
    plane = graph.planes[0]
    np.testing.assert_allclose(points["xyz"][on_wall] @ plane.normal + plane.offset_m, 0, atol=1e-5)
    a, b, c, d = (points["xyz"][quads["corners"][:, i]].astype(float) for i in range(4))
    area = np.linalg.norm(np.cross(b - a, d - a), axis=1)
    assert area.sum() == pytest.approx(sum(p.area_m2 for p in graph.planes.values()), rel=1e-4)
    front = np.einsum("ij,ij->i", np.cross(b - a, c - a), points["normal"][quads["corners"][:, 0]])
    assert (front > 0).all()  # faces look into the room
    assert data == format_planes_ply(graph)


def test_an_empty_graph_makes_empty_files() -> None:
    empty = SceneGraph()
    assert b"element vertex 0\n" in format_planes_ply(empty)
    assert "<svg" in format_floorplan(empty)
    assert class_colours(empty, np.zeros((2, 3))).tolist() == [list(NO_PLANE)] * 2


def test_points_take_the_class_of_their_plane(graph: SceneGraph) -> None:
    wall, ground = graph.planes[0], graph.planes[16]
    middle = graph.rooms[0].centroid
    points = np.array(
        [
            wall.centroid + 0.03 * wall.normal,
            wall.centroid + 0.09 * wall.normal,  # in front of it
            wall.centroid + 30 * wall.extent.axis_u,  # in its plane, far beside
            middle + np.array([0, 0, -0.02]),
            middle + np.array([0, 0, 1.0]),
        ]
    )
    assert plane_of_points(graph, points).tolist() == [0, -1, -1, ground.id, -1]
    assert class_colours(graph, points).tolist() == [
        list(CLASS_COLOURS["wall"]),
        list(NO_PLANE),
        list(NO_PLANE),
        list(CLASS_COLOURS["ground"]),
        list(NO_PLANE),
    ]
    door = graph.doors[0].center
    in_doorway = door + np.array([0, 0, 1.0]) + 0.06 * graph.doors[0].normal
    assert plane_of_points(graph, in_doorway[None]).tolist() == [-1]


# ---- spark-dsg


@pytest.fixture(scope="module")
def loaded(graph: SceneGraph, tmp_path_factory: pytest.TempPathFactory) -> Any:
    path = tmp_path_factory.mktemp("dsg") / "scene_graph.dsg.json"
    path.write_text(format_spark_dsg(graph), encoding="utf-8")
    return spark_dsg.DynamicSceneGraph.load(str(path))


def test_spark_dsg_reads_every_layer(graph: SceneGraph, loaded: Any) -> None:
    layers = spark_dsg.DsgLayers
    expected = {
        layers.BUILDINGS: len(graph.floors),
        layers.ROOMS: len(graph.rooms),
        layers.PLACES: len(graph.places),
        layers.OBJECTS: len(graph.planes) + len(graph.doors) + len(graph.markers),
    }
    for name, count in expected.items():
        assert loaded.get_layer(name).num_nodes() == count
    assert loaded.get_layer(2, "a").num_nodes() == len(graph.keyframes)
    assert loaded.num_nodes() == sum(expected.values()) + len(graph.keyframes)
    room = loaded.get_node(spark_dsg.NodeSymbol("R", 2))
    assert room.attributes.name == "C"
    np.testing.assert_allclose(room.attributes.position, graph.rooms[2].centroid, atol=1e-8)
    assert room.attributes.metadata.get()["kind"] == "corridor"
    box = room.attributes.bounding_box
    assert box.dimensions[2] == pytest.approx(2.6, abs=1e-6)
    label = loaded.get_labelspace(2, 0)
    wall = loaded.get_node(spark_dsg.NodeSymbol("O", 0)).attributes
    assert label.get_category(wall.semantic_label) == "wall"
    box = wall.bounding_box
    assert sorted(box.dimensions) == pytest.approx([0.0, 2.55, 3.95], abs=0.01)
    np.testing.assert_allclose(box.world_R_center @ [0, 0, 1], graph.planes[0].normal, atol=1e-6)


def test_spark_dsg_reads_the_hierarchy(graph: SceneGraph, loaded: Any) -> None:
    symbol = spark_dsg.NodeSymbol

    def parent(prefix: str, number: int) -> int | None:
        return loaded.get_node(symbol(prefix, number)).get_parent()

    assert parent("R", 1) == symbol("B", 0).value
    assert parent("O", 5) == symbol("R", 1).value
    assert parent("p", 2) == symbol("R", 2).value
    assert parent("M", 17) == symbol("R", 0).value
    assert parent("D", 1) == symbol("R", 1).value
    assert loaded.has_edge(symbol("R", 0).value, symbol("R", 2).value)
    assert loaded.get_edge(symbol("R", 0).value, symbol("R", 2).value).info.metadata.get() == {"doors": [0]}
    assert not loaded.has_edge(symbol("R", 0).value, symbol("R", 1).value)
    assert loaded.has_edge(symbol("p", 0).value, symbol("p", 1).value)
    agent = loaded.get_node(symbol("a", 3)).attributes
    np.testing.assert_allclose(agent.position, graph.keyframes[3].world_from_camera[:3, 3], atol=1e-8)
    assert agent.timestamp.total_seconds() == pytest.approx(graph.keyframes[3].timestamp_s)


def test_spark_dsg_saves_what_it_read(loaded: Any, tmp_path: Path) -> None:
    loaded.save(str(tmp_path / "again.json"), False)
    again = spark_dsg.DynamicSceneGraph.load(str(tmp_path / "again.json"))
    assert again.num_nodes() == loaded.num_nodes()
    assert again.num_edges() == loaded.num_edges()


def test_spark_dsg_of_walls_only(walls_only: SceneGraph, tmp_path: Path) -> None:
    path = tmp_path / "d.json"
    path.write_text(format_spark_dsg(walls_only), encoding="utf-8")
    assert format_spark_dsg(walls_only) == path.read_text()
    dsg = spark_dsg.DynamicSceneGraph.load(str(path))
    assert dsg.get_layer(spark_dsg.DsgLayers.OBJECTS).num_nodes() == 16
    assert dsg.get_layer(spark_dsg.DsgLayers.ROOMS).num_nodes() == 0


# ---- floorplan.svg

SVG = "{http://www.w3.org/2000/svg}"


def texts(svg: str) -> list[str]:
    return [element.text or "" for element in ET.fromstring(svg).iter(f"{SVG}text")]  # noqa: S314  (ours)


def filled(svg: str, colour: str) -> list[Array]:
    """Corners of the polygons of one colour."""
    found = re.findall(rf'<path d="M([^"]*)Z" fill="{colour}"', svg)
    return [np.array([pair.split() for pair in data.split("L")], float) for data in found]


def area(corners: Array) -> float:
    x, y = corners.T
    return abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1))) / 2


def test_the_plan_shows_rooms_doors_path_and_scale(graph: SceneGraph) -> None:
    svg = format_floorplan(graph, positions(graph), "Two rooms & a corridor")
    shown = texts(svg)
    for text in ("A", "B", "C", "S", "12.0 m²", "11.8 m²", "kitchen", "2 m", "Two rooms & a corridor"):
        assert text in shown, text
    assert "4 rooms, 41.1 m²" in next(text for text in shown if text.endswith("16 walls  ·  3 doors"))
    assert svg.count("A81 81") == 3  # arcs of three doors 0.9 m wide at 90 px/m
    assert "camera path" in shown
    assert svg == format_floorplan(graph, positions(graph), "Two rooms & a corridor")
    assert "camera path" not in texts(format_floorplan(graph))
    rooms = [
        *filled(svg, "#f4f1e6"),
        *filled(svg, "#e3eefb"),
        *filled(svg, "#e6f4ea"),
        *filled(svg, "#efe8f8"),
    ]
    assert sum(area(corners) for corners in rooms) / 90**2 == pytest.approx(41.1, abs=0.1)


def test_walls_are_cut_at_doors_and_turned_straight(graph: SceneGraph) -> None:
    svg = format_floorplan(graph)
    strips = filled(svg, "#a9b2c1")
    # Of the 16 faces each of the three doors cuts two.
    assert len(strips) == 16 + 6
    for corners in strips:
        assert np.abs(np.diff(corners, axis=0)).min(axis=1) == pytest.approx(0, abs=0.02)
    lengths = sorted(np.ptp(corners, axis=0).max() / 90 for corners in strips)
    assert lengths[-1] == pytest.approx(8.2, abs=0.05)  # 8 m and 0.1 m of body at each corner


def test_thickness_is_drawn_where_both_faces_are_known(snapshot: Any) -> None:
    raw, keyframes = snapshot
    graph = SceneGraph.from_map(raw, keyframes)
    graph.planes[1].other_face, graph.planes[7].other_face = 7, 1
    graph.planes[1].thickness_m = graph.planes[7].thickness_m = 0.12
    svg = format_floorplan(graph)
    bodies = filled(svg, "#2f3a4c")
    assert len(bodies) == 2
    assert np.ptp(bodies[0], axis=0).min() / 90 == pytest.approx(0.12, abs=0.001)
    assert "wall" in texts(svg)


def test_a_plan_of_walls_only(walls_only: SceneGraph) -> None:
    svg = format_floorplan(walls_only, positions(walls_only))
    assert len(filled(svg, "#a9b2c1")) >= 16
    assert "seen only above 1.9 m" in texts(svg)  # the doorways' lintels: nobody told of doors
    assert not any("room" in text for text in texts(svg))
    flat = SceneGraph.from_map({"up": None, "planes": []}, ([], [], np.zeros((0, 4, 4))))
    assert any("not levelled" in text for text in texts(format_floorplan(flat)))


def test_storeys_stand_side_by_side() -> None:
    truth = building()
    upper = building()
    for room in upper["rooms"]:
        room["id"], room["z_floor"], room["level"] = room["id"].lower(), 3.0, 1
        room["centroid"][2] = 3.0
        room["walls"] = [number + 16 for number in room["walls"]]
    for wall in upper["walls"]:
        wall["id"], wall["room"] = wall["id"] + 16, wall["room"].lower()
        wall["p0"][2] = wall["p1"][2] = 3.0
    for floor, ceiling in zip(upper["floors"], upper["ceilings"], strict=True):
        floor["room"], floor["level"], floor["d"] = floor["room"].lower(), 1, -3.0
        ceiling["room"], ceiling["d"] = ceiling["room"].lower(), 5.6
    for door in upper["doors"]:
        door["rooms"] = [name.lower() for name in door["rooms"]]
        door["center"][2] = 3.0
    both = {key: truth[key] + upper[key] for key in truth}
    graph = SceneGraph.from_map(*perfect_map(both, camera_poses(truth)))
    assert graph.frame.zero_height.startswith("ground plane")
    walk = np.array([[0, 0, 1.3], [1, 0, 1.3], [1, 0, 4.3], [2, 0, 4.3]])
    svg = format_floorplan(graph, walk)
    shown = texts(svg)
    assert "floor 1, 0 m" in shown
    assert "floor 2, 3 m" in shown
    assert {"A", "a", "S", "s"} <= set(shown)
    widths = float(re.search(r'width="(\d+)"', svg).group(1))  # type: ignore[union-attr]
    assert widths > 1500


def test_rooms_are_closed_where_no_wall_was_seen(graph: SceneGraph) -> None:
    for plane in graph.planes.values():
        if plane.role == "wall":
            plane.role = "undecided"
    outlines = re.findall(
        r'<path d="M[^"]*Z" fill="#[^"]*" stroke="#667085"[^>]*stroke-dasharray', format_floorplan(graph)
    )
    assert len(outlines) == 4


def test_labels_can_be_read(graph: SceneGraph) -> None:
    sizes = [float(size) for size in re.findall(r'font-size="([0-9.]+)"', format_floorplan(graph))]
    assert min(sizes) >= 10


def test_names_are_escaped(snapshot: Any) -> None:
    raw, keyframes = snapshot
    graph = SceneGraph.from_map(raw, keyframes)
    graph.rooms[0].name = 'a <b> & "c"'
    assert 'a <b> & "c"' in texts(format_floorplan(graph))
