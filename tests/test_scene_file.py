from __future__ import annotations

import copy
import json
import re
from importlib import resources
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from scene_worlds import building, camera_poses, perfect_map

from vsgraphs.errors import InputError
from vsgraphs.scene_graph import (
    ROLES,
    SceneGraph,
    format_scene_graph,
    load_scene_graph,
    relations,
    scene_graph_schema,
)
from vsgraphs.scene_graph.schema import first_violation
from vsgraphs.scene_graph.schema_document import schema_text
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


def test_saved_and_read_back_byte_for_byte(
    snapshot: tuple[Raw, Keyframes], graph: SceneGraph, tmp_path: Path
) -> None:
    text = format_scene_graph(graph)
    path = tmp_path / "scene_graph.json"
    path.write_text(text, encoding="utf-8")
    again = load_scene_graph(path)
    assert format_scene_graph(again) == text
    assert again.estimated == graph.estimated
    assert again.edges == graph.edges
    np.testing.assert_allclose(again.planes[3].normal, graph.planes[3].normal, atol=1e-9)
    raw, keyframes = snapshot
    shuffled = {name: rows[::-1] if isinstance(rows, list) else rows for name, rows in raw.items()}
    assert format_scene_graph(SceneGraph.from_map(shuffled, keyframes)) == text
    assert not re.search(r"-0\.0\b", text)


def test_the_file_keeps_to_its_schema(snapshot: tuple[Raw, Keyframes], graph: SceneGraph) -> None:
    schema = scene_graph_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    bare = SceneGraph.from_map({"up": None, "planes": snapshot[0]["planes"]}, snapshot[1])
    for each in (graph, bare):
        jsonschema.validate(json.loads(format_scene_graph(each)), schema)
    assert tuple(schema["$defs"]["plane"]["properties"]["role"]["enum"]) == ROLES
    assert set(schema["$defs"]["edge"]["properties"]["kind"]["enum"]) == set(relations())


def test_the_shipped_schema_is_up_to_date() -> None:
    shipped = resources.files("vsgraphs.scene_graph").joinpath("scene_graph.schema.json").read_text("utf-8")
    assert shipped == schema_text(), "after a change of a kind of node: python tools/write_schema.py"


def test_our_check_of_the_schema_is_jsonschema_s(graph: SceneGraph) -> None:
    document = json.loads(format_scene_graph(graph))
    validator = jsonschema.Draft202012Validator(scene_graph_schema())
    rng = np.random.default_rng(5)
    wrong: list[Any] = [None, "x", -1, 1.5, [], {}, True, [1, 2]]
    refused = 0
    for _ in range(300):
        damaged = copy.deepcopy(document)
        parent, key = _random_place(damaged, rng)
        if rng.random() < 0.3 and isinstance(parent, dict):
            del parent[key]
        else:
            parent[key] = wrong[rng.integers(len(wrong))]
        ours = first_violation(damaged)
        assert (ours is None) == validator.is_valid(damaged), (key, ours)
        refused += ours is not None
    assert 100 < refused < 300


def _random_place(value: Any, rng: np.random.Generator) -> tuple[Any, Any]:
    """A random item somewhere below, as its container and key."""
    keys = list(value) if isinstance(value, dict) else list(range(len(value)))
    key = keys[rng.integers(len(keys))]
    below = value[key]
    if isinstance(below, dict | list) and len(below) and rng.random() < 0.8:
        return _random_place(below, rng)
    return value, key


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: d.update(version=2), "written by a newer vsgraphs .format version 2"),
        (lambda d: d.update(version="1"), "expected a positive integer"),
        (lambda d: d.update(format="atlas"), "not a scene graph of vsgraphs"),
        (lambda d: d["planes"][4].pop("normal"), r"planes\[4\] has no 'normal'"),
        (lambda d: d["planes"][4].update(role="roof"), r"planes\[4\].role must be one of undecided"),
        (lambda d: d["rooms"][0].update(floor=8), "room 0 names floor 8, which is not there"),
        (lambda d: d["edges"][0].update(source="keyframe:99"), "names 'keyframe:99', which is not there"),
    ],
)
def test_broken_files_are_one_line(graph: SceneGraph, tmp_path: Path, change: Any, message: str) -> None:
    document = json.loads(format_scene_graph(graph))
    change(document)
    path = tmp_path / "g.json"
    path.write_text(json.dumps(document))
    with pytest.raises(InputError, match=message) as caught:
        load_scene_graph(path)
    assert "\n" not in str(caught.value)
    assert str(path) in str(caught.value)


def test_files_that_are_no_scene_graph(graph: SceneGraph, tmp_path: Path) -> None:
    path = tmp_path / "g.json"
    with pytest.raises(InputError, match="cannot read scene graph"):
        load_scene_graph(path)
    text = format_scene_graph(graph)
    for content, message in (
        (text[: len(text) // 2].encode(), "copied completely"),
        (b"", "copied completely"),
        (b"\xff\xfe\x00", "not text"),
        (b"[1, 2]", "not a scene graph"),
        (text.replace("1.3", "NaN", 1).encode(), r"g\.json:\d+: NaN is no number"),
    ):
        path.write_bytes(content)
        with pytest.raises(InputError, match=message):
            load_scene_graph(path)
