"""A kind of element that nothing else knows of: its line in KINDS brings it into all that a graph becomes."""

from __future__ import annotations

import copy
import json
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import MagicMock

import jsonschema
import numpy as np
import pytest
import spark_dsg
from scene_worlds import building, camera_poses, perfect_map

from vsgraphs.cli.compare_run import _print as print_run
from vsgraphs.cli.compare_scene import _print as print_scene
from vsgraphs.errors import InputError
from vsgraphs.evaluate.scene import SceneScores, align_poses, evaluate_scene, parse_scene_truth
from vsgraphs.export.floorplan import format_floorplan
from vsgraphs.export.spark_dsg import format_spark_dsg
from vsgraphs.run.report import _scene_counts
from vsgraphs.run.summary import what_was_found
from vsgraphs.scene_graph import (
    KINDS,
    ElementKind,
    SceneGraph,
    format_scene_graph,
    load_scene_graph,
    scene_graph_schema,
)
from vsgraphs.scene_graph.kinds import SparkPlace
from vsgraphs.trajectory import Array
from vsgraphs.view.layers import layered_graph
from vsgraphs.view.scene import log_scene
from vsgraphs.view.surfaces import box_outline, upright

Raw = dict[str, Any]
COLOUR = (12, 34, 56)


class ShelfKind(ElementKind):
    """All that a kind of element takes."""

    name, section = "shelf", "shelves"
    colour = COLOUR
    spark = SparkPlace("objects", "S", ("shelf",))
    description = "A board on a wall."
    truth = "shelves"


@pytest.fixture
def shelf_kind() -> Iterator[ShelfKind]:
    kind = ShelfKind()
    KINDS.append(kind)
    yield kind
    KINDS.remove(kind)


# In the truth's frame; room A is number 0, B 1; wall 0 is A's at y = 0.
SHELVES: list[Raw] = [
    {"id": 8, "kind": "shelf", "centre": (6.0, 0.2, 1.4), "along": (1.0, 0, 0), "size_m": (1, 0.4, 0.1),
     "planes": [4], "rooms": [1]},
    {"id": 3, "kind": "shelf", "centre": (2.0, 0.2, 1.2), "along": (1.0, 0, 0), "size_m": (2, 0.4, 0.3),
     "planes": [0], "rooms": [0]},
    {"id": 4, "kind": "fountain", "centre": (1.0, 1.0, 1.0), "along": (1.0, 0, 0), "size_m": (1, 1, 1),
     "planes": [], "rooms": []},
]  # fmt: skip


def shelved() -> tuple[Raw, tuple[Array, Array, Array], Array, Raw]:
    """The map with its elements, keyframes, the true poses, the truth."""
    truth = building()
    poses = camera_poses(truth)
    raw, keyframes = perfect_map(truth, poses)
    into_map = np.linalg.inv(poses[0])
    raw["elements"] = copy.deepcopy(SHELVES)
    for row in raw["elements"]:
        row["centre"] = into_map[:3, :3] @ row["centre"] + into_map[:3, 3]
        row["along"] = into_map[:3, :3] @ row["along"]
    return raw, keyframes, poses, truth


def shelved_graph() -> SceneGraph:
    raw, keyframes, _, _ = shelved()
    return SceneGraph.from_map(raw, keyframes)


def test_elements_become_nodes_in_the_levelled_frame(shelf_kind: ShelfKind) -> None:
    raw, keyframes, poses, _ = shelved()
    graph = SceneGraph.from_map(raw, keyframes)
    assert list(graph.section("shelves")) == list(graph.elements["shelves"]) == [3, 8]
    shelf = graph.elements["shelves"][3]
    to_graph = graph.frame.world_from_map @ np.linalg.inv(poses[0])
    np.testing.assert_allclose(shelf.center, to_graph[:3, :3] @ (2.0, 0.2, 1.2) + to_graph[:3, 3], atol=1e-9)
    assert abs(shelf.along[2]) < 1e-9
    assert (shelf.kind, shelf.planes, shelf.rooms) == ("shelf", [0], [0])
    assert shelf.center[2] == pytest.approx(1.2)
    corners = shelf_kind.box(shelf, graph).corners()
    assert np.ptp(corners[:, 2]) == pytest.approx(0.3)
    assert np.linalg.norm(corners[1] - corners[0]) == pytest.approx(2.0)
    assert corners[4:, 2].min() > corners[:4, 2].max()
    wall = graph.planes[0]
    assert (corners[:, :3] @ wall.normal + wall.offset_m).min() == pytest.approx(0, abs=1e-6)
    edges = {(edge.kind, edge.source, edge.target) for edge in graph.edges}
    assert {("shows", "plane:0", "shelf:3"), ("lies_in", "shelf:3", "room:0")} <= edges


def test_the_file_and_its_schema_have_a_section_of_them(shelf_kind: ShelfKind, tmp_path: Path) -> None:
    graph = shelved_graph()
    text = format_scene_graph(graph)
    jsonschema.validate(json.loads(text), scene_graph_schema())
    (tmp_path / "scene_graph.json").write_text(text, encoding="utf-8")
    again = load_scene_graph(tmp_path / "scene_graph.json")
    assert format_scene_graph(again) == text
    assert "shelves" in again.estimated
    rows = json.loads(text)["shelves"]
    assert [list(row) for row in rows] == [["id", "kind", "center", "along", "size_m", "planes", "rooms"]] * 2
    damaged = {**json.loads(text), "shelves": [{**rows[0], "kind": "plank"}]}
    assert not jsonschema.Draft202012Validator(scene_graph_schema()).is_valid(damaged)


def test_without_the_key_nobody_looked(shelf_kind: ShelfKind) -> None:
    raw, keyframes, _, _ = shelved()
    raw["elements"] = []
    none_found = SceneGraph.from_map(raw, keyframes)
    assert json.loads(format_scene_graph(none_found))["shelves"] == []
    assert _scene_counts(none_found)["shelves"] == 0
    del raw["elements"]
    not_sought = SceneGraph.from_map(raw, keyframes)
    assert "shelves" not in json.loads(format_scene_graph(not_sought))
    assert "shelves" not in _scene_counts(not_sought)


def test_elements_of_no_known_kind_are_left_out() -> None:
    raw, keyframes, _, _ = shelved()
    with_them = SceneGraph.from_map(raw, keyframes)
    raw["elements"] = []
    without = SceneGraph.from_map(raw, keyframes)
    assert format_scene_graph(with_them) == format_scene_graph(without)
    assert format_spark_dsg(with_them) == format_spark_dsg(without)
    assert format_floorplan(with_them) == format_floorplan(without)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"centre": (np.nan, 0, 0)}, "shelf 3: centre: not finite"),
        ({"along": (2.0, 0, 0)}, "shelf 3: 'along' has length 2, expected 1"),
        ({"size_m": (1.0, -1.0, 1.0)}, "shelf 3: its size is"),
        ({"rooms": [77]}, "shelf 3 names room 77, which is not there"),
    ],
)
def test_broken_elements_are_refused(shelf_kind: ShelfKind, change: Raw, message: str) -> None:
    raw, keyframes, _, _ = shelved()
    raw["elements"][1] |= change
    with pytest.raises(InputError, match=message):
        SceneGraph.from_map(raw, keyframes)


def test_spark_dsg_loads_them_as_objects_with_a_label(shelf_kind: ShelfKind, tmp_path: Path) -> None:
    path = tmp_path / "graph.json"
    graph = shelved_graph()
    path.write_text(format_spark_dsg(graph), encoding="utf-8")
    loaded = spark_dsg.DynamicSceneGraph.load(str(path))
    node = loaded.get_node(spark_dsg.NodeSymbol("S", 3).value)
    assert node.attributes.name == "shelf 3"
    np.testing.assert_allclose(node.attributes.bounding_box.dimensions, (2, 0.4, 0.3), atol=1e-6)
    assert node.get_parent() == spark_dsg.NodeSymbol("R", 0).value
    labels = dict(json.loads(path.read_text())["metadata"]["labelspaces"]["_l2p0"])
    assert labels[node.attributes.semantic_label] == "shelf"


def test_letters_and_names_are_each_of_one_kind() -> None:
    for names in zip(*((kind.name, kind.section, kind.spark.symbol) for kind in KINDS), strict=True):
        assert len(set(names)) == len(KINDS)


def test_the_plan_shows_them_in_their_place(shelf_kind: ShelfKind) -> None:
    svg = format_floorplan(shelved_graph())
    ET.fromstring(svg)  # noqa: S314  (our own)
    drawn = [line for line in svg.splitlines() if "#0c2238" in line]
    assert len(drawn) == 3  # two shelves, and the legend
    assert "2 shelves" in svg
    shelf_kind.in_plan = False
    assert "#0c2238" not in format_floorplan(shelved_graph())


def test_the_viewer_has_their_boxes_and_their_layer(shelf_kind: ShelfKind) -> None:
    graph = shelved_graph()
    up = upright(graph)
    shelf = graph.elements["shelves"][3]
    outline = box_outline(shelf_kind.box(shelf, graph), up)
    steps = np.linalg.norm(np.diff(outline, axis=0), axis=1)
    assert set(np.round(steps, 6)) == {2.0, 0.4, 0.3}  # along edges only
    assert len({tuple(np.round(corner, 6)) for corner in outline}) == 8
    layered = layered_graph(graph, up)
    layer = layered.layers["shelf"]
    assert (layer.section, layer.colours.tolist()) == ("shelves", [list(COLOUR)] * 2)
    assert layer.places[0, 2] == layered.layers["plane"].places[0, 2]
    assert len(layered.edges["lies_in"]) == 2


def test_the_viewer_is_sent_them_with_their_names(
    shelf_kind: ShelfKind, monkeypatch: pytest.MonkeyPatch
) -> None:
    rerun, sinks = MagicMock(), MagicMock()
    monkeypatch.setattr("vsgraphs.view.scene.rerun", lambda: rerun)
    log_scene(sinks, shelved_graph(), np.eye(4))
    paths = [call.args[0] for call in sinks.log.call_args_list]
    assert {"world/shelves", "world/shelves/names", "world/graph/shelves", "world/graph/rooms"} <= set(paths)
    labels = [call.kwargs.get("labels") for call in rerun.Points3D.call_args_list]
    assert ["shelf 3", "shelf 8"] in labels


def test_a_run_counts_them(shelf_kind: ShelfKind) -> None:
    figures = _scene_counts(shelved_graph())
    assert figures["shelves"] == 2
    assert what_was_found(figures) == "4 rooms, 3 doors, 16 walls, 1 floor, 2 shelves, 41 m2"
    assert "1 shelf," in what_was_found({**figures, "shelves": 1})


# ---- scores


def true_shelf(number: int, x: float, room: str = "A", **more: Any) -> Raw:
    return {"id": number, "room": room, "center": [x, 0.2, 1.2], **more}


def scored(listed: list[Raw] | None, raw: Raw | None = None) -> SceneScores:
    found, keyframes, poses, truth = shelved()
    graph = SceneGraph.from_map(raw or found, keyframes)
    estimate = np.array([keyframe.world_from_camera for keyframe in graph.keyframes.values()])
    document = truth if listed is None else {**truth, "shelves": listed}
    return evaluate_scene(graph, parse_scene_truth(document, "truth"), align_poses(estimate, poses))


def test_they_are_scored_by_their_middles(shelf_kind: ShelfKind) -> None:
    score = scored([true_shelf(0, 2.3), true_shelf(1, 3.5), true_shelf(2, 9.0, "S")]).structure["shelves"]
    assert (score.detected, score.true, score.false, score.ignored) == (1, 2, 1, 0)
    assert score.mean_error("center_m") == pytest.approx(0.3, abs=1e-6)
    assert (score.precision, score.recall) == (0.5, 0.5)
    missed = scored([true_shelf(0, 2.51)]).structure["shelves"]  # 0.5 m is the most
    assert (missed.detected, missed.false) == (0, 2)


@pytest.mark.parametrize("more", [{"observed": False}, {"counted": False}, {"room": "S"}])
def test_true_ones_that_need_not_be_found_are_neither_hit_nor_false(shelf_kind: ShelfKind, more: Raw) -> None:
    score = scored([{**true_shelf(0, 2.0), **more}]).structure["shelves"]
    assert (score.detected, score.true, score.false, score.ignored) == (0, 0, 1, 1)


def test_without_a_list_of_middles_there_is_nothing_to_score(shelf_kind: ShelfKind) -> None:
    assert "shelves" not in scored(None).structure
    assert "shelves" not in scored([{"room": "A", "n": [0, 0, 1], "d": 1.0}]).to_json()["structural_elements"]
    raw = shelved()[0]
    del raw["elements"]
    not_sought = scored([true_shelf(0, 2.0)], raw).structure["shelves"]
    assert (not_sought.estimated, not_sought.true) == (False, 1)


def test_both_tables_of_scores_tell_them(shelf_kind: ShelfKind, capsys: pytest.CaptureFixture[str]) -> None:
    scores = scored([true_shelf(0, 2.3)])
    accuracy = SimpleNamespace(ate=SimpleNamespace(rmse=0.01), completion=1.0, path_m=10.0)
    print_scene(scores, accuracy)  # type: ignore[arg-type]
    print_run(scores, accuracy)  # type: ignore[arg-type]
    rows = [line.split() for line in capsys.readouterr().out.splitlines() if "shelves" in line]
    assert rows[0][:5] == ["shelves", "1", "/", "1", "1"]
    assert rows[1][:5] == ["shelves", "1", "of", "1", "1"]
