"""Rooms and doors named by markers, and what is said where markers contradict each other."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from vsgraphs.export.floorplan import format_floorplan
from vsgraphs.export.spark_dsg import format_spark_dsg
from vsgraphs.markers import MarkerRegistry, NamedMarker, name_by_markers, told_of_two_places
from vsgraphs.scene_graph import (
    DoorNode,
    Frame,
    MarkerNode,
    RoomNode,
    SceneGraph,
    format_scene_graph,
    parse_scene_graph,
)
from vsgraphs.trajectory import Array


def room(number: int, polygon: list[tuple[float, float]]) -> RoomNode:
    corners = np.array([(x, y, 0.0) for x, y in polygon])
    return RoomNode(
        id=number,
        name=f"room {number + 1}",
        kind="room",
        walls=[],
        ground=None,
        polygon=corners,
        centroid=corners.mean(axis=0),
        height_m=2.6,
        area_m2=20.0,
        partial=False,
        floor=None,
    )


def marker(
    number: int, x: float, y: float, facing: tuple[float, float], z: float = 1.5, seen: int = 3
) -> MarkerNode:
    out = np.array([*facing, 0.0])
    up = np.array([0.0, 0.0, 1.0])
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack([np.cross(up, out), up, out])
    pose[:3, 3] = x, y, z
    return MarkerNode(number, "", pose, 0.16, list(range(seen)), None)


def graph(*markers: MarkerNode) -> SceneGraph:
    """An L-shaped room 0, room 1 behind a wall of 0.14 m to its right, a door between them."""
    made = SceneGraph(frame=Frame(levelled=True))
    made.rooms = {
        0: room(0, [(0, 0), (5, 0), (5, 4), (3, 4), (3, 2), (0, 2)]),
        1: room(1, [(5.14, 0), (9, 0), (9, 4), (5.14, 4)]),
    }
    made.doors = {
        0: DoorNode(0, (0, 1), np.array([5.07, 1.0, 0]), 0.9, 2.0, np.array([1.0, 0, 0]), "door"),
        1: DoorNode(1, (1, None), np.array([9.0, 3.0, 0]), 0.9, 2.0, np.array([1.0, 0, 0]), "door"),
    }
    made.keyframes = {}
    made.markers = {m.id: m for m in markers}
    for m in markers:
        m.observed_by = []
    return made


def registry(**names: tuple[str, str]) -> MarkerRegistry:
    """m7=("kitchen", "room")"""
    rows = {int(key[1:]): NamedMarker(name, kind, 0.16) for key, (name, kind) in names.items()}
    return MarkerRegistry("4x4_50", 0.16, rows)


def names_edges(made: SceneGraph) -> list[tuple[str, str]]:
    return [(edge.source, edge.target) for edge in made.edges if edge.kind == "names"]


def test_a_marker_on_a_wall_names_the_room_it_looks_into() -> None:
    # Both faces of the wall between the rooms, each a few cm off the polygon; and one in the notch of the L.
    made = graph(marker(7, 5.04, 3, (-1, 0)), marker(8, 5.1, 3, (1, 0)))
    warnings = name_by_markers(made, registry(m7=("kitchen", "room"), m8=("hall", "corridor")))
    assert warnings == []
    assert [(r.name, r.kind) for r in made.rooms.values()] == [("kitchen", "room"), ("hall", "corridor")]
    assert names_edges(made) == [("marker:7", "room:0"), ("marker:8", "room:1")]
    assert made.room("kitchen").id == 0


@pytest.mark.parametrize(
    ("x", "y", "facing", "z", "expected"),
    [
        (2.0, 1.98, (0, -1), 1.5, 0),  # on the wall of the notch, looking into the room
        (2.0, 2.02, (0, -1), 1.5, 0),
        (2.0, 2.1, (0, 1), 1.5, None),  # on its other side
        (2.97, 3.0, (1, 0), 1.5, 0),  # in the L's other arm
        (2.0, 3.0, (0, -1), 1.5, None),  # in the notch, outside of all rooms
        (1.0, 1.0, (1, 0), 1.0, 0),  # on something in the middle
        (0.01, 1.0, (1, 0), 4.0, None),  # a storey above
        (0.01, 1.0, (1, 0), -1.5, None),
        (-0.5, 1.0, (1, 0), 1.5, None),  # too far behind the wall
    ],
)
def test_where_a_marker_hangs(
    x: float, y: float, facing: tuple[float, float], z: float, expected: int | None
) -> None:
    made = graph(marker(7, x, y, facing, z))
    warnings = name_by_markers(made, registry(m7=("kitchen", "room")))
    assert made.markers[7].room == expected
    assert (made.rooms[0].name == "kitchen") == (expected == 0)
    assert warnings == (
        [] if expected == 0 else ["markers: marker 7 ('kitchen') hangs in no room that was found"]
    )


def test_a_door_marker_names_the_nearest_door() -> None:
    made = graph(marker(7, 5.0, 1.8, (-1, 0)), marker(8, 8.9, 1.0, (-1, 0)))
    assert name_by_markers(made, registry(m7=("front", "door"))) == []
    assert [door.name for door in made.doors.values()] == ["front", ""]
    assert [r.name for r in made.rooms.values()] == ["room 1", "room 2"]
    assert names_edges(made) == [("marker:7", "door:0")]
    assert (made.markers[7].room, made.markers[7].door) == (0, 0)


def test_a_door_marker_far_from_all_doors_is_told() -> None:
    made = graph(marker(7, 0.01, 1.0, (1, 0)))
    warnings = name_by_markers(made, registry(m7=("front", "door")))
    assert warnings == ["markers: marker 7 ('front') hangs near no door that was found"]
    assert names_edges(made) == []


def test_markers_the_file_does_not_name_stay_and_name_nothing() -> None:
    made = graph(marker(20, 0.01, 1.0, (1, 0)))
    assert name_by_markers(made, registry()) == []
    assert made.markers[20].room == 0
    assert made.markers[20].name == ""
    assert made.rooms[0].name == "room 1"
    assert names_edges(made) == []


def test_one_name_in_two_rooms_names_neither() -> None:
    made = graph(marker(7, 5.0, 3, (-1, 0)), marker(8, 5.14, 3, (1, 0)), marker(9, 0.01, 1, (1, 0)))
    warnings = name_by_markers(
        made, registry(m7=("kitchen", "room"), m8=("kitchen", "room"), m9=("kitchen", "room"))
    )
    assert warnings == [
        "markers: room 'kitchen' is named by markers 7, 8, 9, which hang at different rooms: not named"
    ]
    assert [r.name for r in made.rooms.values()] == ["room 1", "room 2"]
    assert names_edges(made) == []


def test_two_names_for_one_room_name_nothing_but_two_markers_of_one_name_do() -> None:
    made = graph(marker(7, 5.0, 3, (-1, 0)), marker(9, 0.01, 1, (1, 0)))
    warnings = name_by_markers(made, registry(m7=("kitchen", "room"), m9=("office", "room")))
    assert warnings == ["markers: one room has the names 'kitchen', 'office' by markers 7, 9: not named"]
    assert made.rooms[0].name == "room 1"
    made = graph(marker(7, 5.0, 3, (-1, 0)), marker(9, 0.01, 1, (1, 0)))
    assert name_by_markers(made, registry(m7=("kitchen", "room"), m9=("kitchen", "room"))) == []
    assert made.rooms[0].name == "kitchen"
    assert len(names_edges(made)) == 2


def test_markers_of_the_file_that_were_not_seen_are_told() -> None:
    made = graph()
    warnings = name_by_markers(made, registry(m7=("kitchen", "room"), m9=("office", "room")))
    assert warnings == ["markers: of the marker file these are not in the map: 7 ('kitchen'), 9 ('office')"]


def test_without_up_nothing_is_named() -> None:
    made = graph(marker(7, 5.0, 3, (-1, 0)))
    made.frame = Frame(levelled=False)
    (warning,) = name_by_markers(made, registry(m7=("kitchen", "room")))
    assert "nothing was named: which way is up is not known" in warning
    assert made.rooms[0].name == "room 1"


def raw_marker(number: int, places: list[tuple[float, int]]) -> dict[str, Any]:
    return {
        "id": number,
        "size_m": 0.16,
        "world_from_marker": np.eye(4),
        "observed_by": list(range(places[0][1])),
        "in_two_places": len(places) > 1 and places[1][1] > 1,
        "places": [
            {"position": np.array([x, 0, 0]), "observed_by": list(range(count))} for x, count in places
        ],
    }


def test_a_marker_in_two_places_is_in_no_graph_and_told() -> None:
    raw = {
        "up": None,
        "planes": [],
        "markers": [raw_marker(7, [(0, 4), (3.25, 3)]), raw_marker(8, [(1, 4), (9, 1)])],
    }
    keyframes: tuple[Array, Array, Array] = (np.arange(5), np.arange(5.0), np.tile(np.eye(4), (5, 1, 1)))
    made = SceneGraph.from_map(raw, keyframes)
    assert list(made.markers) == [8]
    assert told_of_two_places(raw) == [
        "markers: marker 7 was seen in two places, 3.25 m apart (4 and 3 keyframes): rejected; "
        "hang each number once"
    ]


def test_names_are_in_all_files() -> None:
    made = graph(marker(7, 5.0, 3, (-1, 0)), marker(8, 5.0, 1.6, (-1, 0)))
    name_by_markers(made, registry(m7=("kitchen", "room"), m8=("front", "door")))
    document = json.loads(format_scene_graph(made))
    assert [row["name"] for row in document["rooms"]] == ["kitchen", "room 2"]
    assert [row["name"] for row in document["doors"]] == ["front", ""]
    assert {
        "kind": "names",
        "source": "marker:8",
        "target": "door:0",
        "factor": None,
        "via": None,
    } in document["edges"]
    again = parse_scene_graph(document, "test")
    assert format_scene_graph(again) == format_scene_graph(made)
    assert "kitchen" in format_floorplan(made, np.zeros((0, 3)))
    spark = json.loads(format_spark_dsg(made))
    names = [node["attributes"].get("name") for node in spark["nodes"]]
    assert {"kitchen", "front"} <= set(names)


def test_files_from_before_doors_had_names_are_read() -> None:
    made = graph(marker(8, 5.0, 1.6, (-1, 0)))
    name_by_markers(made, registry(m8=("front", "door")))
    document = json.loads(format_scene_graph(made))
    document["edges"] = []
    for row in document["doors"]:
        del row["name"]
    for row in document["markers"]:
        del row["door"]
    again = parse_scene_graph(document, "old")
    assert again.doors[0].name == ""
    assert again.markers[8].door is None
