"""Generated buildings: sound, walkable, alike where they should be, and as asked for."""

from __future__ import annotations

import json
import time
from collections import Counter
from typing import Any

import numpy as np
import plan_geometry as geometry
import pytest

from vsgraphs.compiled import core
from vsgraphs.errors import InputError
from vsgraphs.plans import BUILDING_KINDS, building, load_plan, plan_text
from vsgraphs.plans.buildings.draw import Draw

Plan = dict[str, Any]
SIZES = [(2, 1), (5, 2), (16, 16), (37, 4)]
CASES = [(kind, *size, seed) for kind in BUILDING_KINDS for seed, size in enumerate(SIZES)]
_CAMERA_CLEARANCE_M = 0.3  # to furniture, of the way before its corners are rounded


@pytest.fixture(scope="module", params=CASES, ids=lambda case: "-".join(map(str, case)))
def made(request: pytest.FixtureRequest) -> Plan:
    return building(*request.param)


def offices(plan: Plan) -> list[dict[str, Any]]:
    return [room for room in plan["rooms"] if room.get("kind", "room") == "room" and room["id"] != "H"]


def rooms_of(plan: Plan) -> dict[str, dict[str, Any]]:
    return {room["id"]: room for room in plan["rooms"]}


def of(plan: Plan, what: str, room: str) -> list[dict[str, Any]]:
    return [item for item in plan.get(what, []) if item["room"] == room]


def room_of(plan: Plan, point: dict[str, Any]) -> str:
    """The one room a way-point lies in."""
    if "room" in point:
        return str(point["room"])
    at = np.array(point["at"])
    found = [room["id"] for room in plan["rooms"] if geometry.inside(at, geometry.outline(room))]
    assert len(found) == 1, point
    return str(found[0])


def test_as_many_rooms_and_furnishings_as_asked_for(made: Plan) -> None:
    kind, rooms, furnishings, _ = made["name"].split("-")
    assert len(offices(made)) == int(rooms)
    shown = Counter(appearance(made, room) for room in offices(made))
    assert len(shown) == int(furnishings)
    if kind != "storeys":
        assert max(shown.values()) - min(shown.values()) <= 1


def appearance(plan: Plan, room: dict[str, Any]) -> str:
    """Everything of an office but where the door is and what hangs beside it, in its own frame."""
    boxes = [
        (box["kind"], box["seed"], box["size"], box.get("z", 0), geometry.local(room, box["at"]))
        for box in of(plan, "boxes", room["id"])
    ]
    hung = [
        sorted((key, value) for key, value in item.items() if key != "room")
        for what in ("posters", "windows")
        for item in of(plan, what, room["id"])
        if item["wall"] != 0
    ]
    corners = [geometry.local(room, corner) for corner in room["polygon"]]
    return json.dumps([sorted(boxes), hung, corners, room["floor"], room["wall_colour"]])


def test_furnishings_differ_in_more_than_a_seed() -> None:
    plan = building("line", 40, 40)
    kinds = Counter(
        tuple(sorted(box["kind"] for box in of(plan, "boxes", room["id"]))) for room in offices(plan)
    )
    assert len(kinds) > 15


def test_rooms_lie_apart(made: Plan) -> None:
    rooms = made["rooms"]
    for i, a in enumerate(rooms):
        for b in rooms[:i]:
            (low_a, high_a), (low_b, high_b) = geometry.heights(a), geometry.heights(b)
            if min(high_a, high_b) > max(low_a, low_b):
                gap = geometry.distance(geometry.outline(a), geometry.outline(b))
                assert gap > 0.119, (a["id"], b["id"])


def test_furniture_stands_free_in_its_room(made: Plan) -> None:
    for name, room in rooms_of(made).items():
        boxes = of(made, "boxes", name)
        shapes = [geometry.footprint(box) for box in boxes]
        for i, (box, shape) in enumerate(zip(boxes, shapes, strict=True)):
            assert all(geometry.inside(corner, geometry.outline(room), 0.01) for corner in shape), box
            low, high = box.get("z", 0), box.get("z", 0) + box["size"][2]
            below = [
                other
                for other, under in zip(boxes, shapes, strict=True)
                if abs(other.get("z", 0) + other["size"][2] - low) < 1e-6
                and geometry.distance(shape, under) < 0
            ]
            assert low == 0 or below, box
            for other, beside in zip(boxes[:i], shapes[:i], strict=True):
                o_low, o_high = other.get("z", 0), other.get("z", 0) + other["size"][2]
                if min(high, o_high) > max(low, o_low) + 1e-6:
                    assert geometry.distance(shape, beside) > 0, (box, other)


def test_doors_are_free(made: Plan) -> None:
    doors = 0
    for door, room, along, into in geometry.walls_of_doors(made):
        doors += 1
        half, at = door.get("width", 0.95) / 2, np.array(door["at"])
        before = np.array([at - half * along, at + half * along])
        before = np.array([*before, *(before[::-1] + 0.8 * into)])
        for box in of(made, "boxes", room):
            assert geometry.distance(before, geometry.footprint(box)) > 0.05, (door, box)
    assert doors == 2 * len(made["doors"])


def test_the_way_is_free(made: Plan) -> None:
    points = made["path"]["waypoints"]
    shapes = {name: [geometry.footprint(box) for box in of(made, "boxes", name)] for name in rooms_of(made)}
    for here, there in zip(points, [*points[1:], points[0]], strict=True):
        segment = np.array([here["at"], there["at"]])
        for name in {room_of(made, here), room_of(made, there)}:
            for shape in shapes[name]:
                assert geometry.distance(segment, shape) > _CAMERA_CLEARANCE_M, (here, there)


def test_pictures_hang_free(made: Plan) -> None:
    doors = [
        (room, np.array(door["at"]), door.get("width", 0.95) / 2, into)
        for door, room, _, into in geometry.walls_of_doors(made)
    ]
    for name, room in rooms_of(made).items():
        tall = [geometry.footprint(box) for box in of(made, "boxes", name) if box["size"][2] > 1.0]
        pictures = of(made, "posters", name)
        for i, picture in enumerate(pictures):
            ends = np.array(geometry.place_on_wall(room, picture))
            if room.get("kind") != "stairs":  # there doors and pictures hang at several heights
                for where, at, half, into in doors:
                    same_wall = where == name and np.abs((ends - at) @ into).max() < 0.1
                    near = np.linalg.norm(ends.mean(axis=0) - at) < half + picture["width"] / 2 + 0.05
                    assert not (same_wall and near), picture
            assert all(geometry.distance(ends, shape) > 0.04 for shape in tall) or name == "H", picture
            for other in pictures[:i]:
                if other["wall"] == picture["wall"]:
                    apart = abs(other["along"] - picture["along"]) - (other["width"] + picture["width"]) / 2
                    assert apart > 0.05 or abs(other["z"] - picture["z"]) > 0.9, (picture, other)


def test_the_walk_enters_every_office_and_comes_back(made: Plan) -> None:
    path = made["path"]
    assert path["closed"]
    rooms = [room_of(made, point) for point in path["waypoints"]]
    assert set(rooms) == set(rooms_of(made))
    for room in offices(made):
        inside = [p for p, name in zip(path["waypoints"], rooms, strict=True) if name == room["id"]]
        assert geometry.turned_deg(geometry.headings_deg(inside)) > 330
    first, last = (np.array(path["waypoints"][i]["at"]) for i in (0, -1))
    assert np.linalg.norm(first - last) < 30  # the last leg: along the corridor at most


def test_storeys_are_alike() -> None:
    plan = building("storeys", 18, 4, 3, storeys=3)
    by_level: dict[int, list[Any]] = {}
    for room in offices(plan):
        corners = [tuple(corner) for corner in room["polygon"]]
        doors = [door["at"] for door in plan["doors"] if room["id"] in door["rooms"]]
        by_level.setdefault(room.get("level", 0), []).append((corners, doors, appearance(plan, room)))
    assert by_level[0] == by_level[1] == by_level[2]
    hung = [
        [{k: v for k, v in item.items() if k != "room"} for item in of(plan, "posters", f"C{level}")]
        for level in range(3)
    ]
    assert hung[0] == hung[1] == hung[2]
    assert len(plan["stairs"]) == 2


def test_storeys_that_do_not_come_out_even() -> None:
    plan = building("storeys", 7, 7, storeys=3)
    levels = Counter(room.get("level", 0) for room in offices(plan))
    assert levels == {0: 3, 1: 2, 2: 2}
    assert len({appearance(plan, room) for room in offices(plan)}) == 7
    plan = building("storeys", 12, 12)
    assert len({appearance(plan, room) for room in offices(plan)}) == 12


def test_doors_stand_in_different_places() -> None:
    plan = building("line", 30, 1)
    rooms = rooms_of(plan)
    places = Counter(geometry.local(rooms[door["rooms"][1]], door["at"])[0] for door in plan["doors"])
    assert len(places) == 3
    assert min(places.values()) >= 2


def test_equal_arguments_give_equal_plans_and_others_do_not() -> None:
    assert building("ring", 9, 3, 7) == building("ring", 9, 3, 7)
    plans = [json.dumps(building("ring", 9, 3, seed)) for seed in range(6)]
    assert len(set(plans)) == 6
    # Written down, so that a published building stays what it is.
    draw = Draw(5, "x")
    assert [draw.whole(100) for _ in range(6)] == [66, 39, 56, 7, 89, 56]


@pytest.mark.parametrize("kind", BUILDING_KINDS)
def test_the_core_can_build_and_walk_it(kind: str) -> None:
    for rooms, furnishings, seed in ((3, 2, 11), (13, 4, 12)):
        scene = core().build_scene(load_plan(building(kind, rooms, furnishings, seed)).plan)
        truth = core().scene_truth(scene, core().ObservationCounter(scene))
        counted = [room for room in truth["rooms"] if room["kind"] == "room"]
        assert len(counted) == rooms + (kind == "star")


def test_less_on_the_walls_and_on_the_floor() -> None:
    full = building("line", 12)
    bare = building("line", 12, bareness=1.0)
    assert "posters" not in bare
    assert bare["boxes"] == full["boxes"]
    empty = building("line", 12, furniture=0.0)
    assert "boxes" not in empty
    half = building("line", 12, furniture=0.5, bareness=0.5)
    assert len(full["boxes"]) / 4 < len(half["boxes"]) < 3 * len(full["boxes"]) / 4
    assert len(full["posters"]) / 4 < len(half["posters"]) < 3 * len(full["posters"]) / 4
    assert not of(building("line", 12, corridor_posters=False), "posters", "C")
    assert of(full, "posters", "C")


def test_large_ones_take_no_time() -> None:
    for kind in BUILDING_KINDS:
        began = time.process_time()
        building(kind, 60, 4)
        assert time.process_time() - began < 1


def test_the_text_of_a_plan() -> None:
    plan = building("storeys", 4, 2)
    text = plan_text(plan)
    assert json.loads(text) == plan
    assert sum(line.lstrip().startswith('{"id": ') for line in text.splitlines()) == len(plan["rooms"])


@pytest.mark.parametrize(
    ("arguments", "options", "message"),
    [
        (("lien",), {}, "building must be one of line, ring, star, storeys, not 'lien'"),
        (("line", 0), {}, "rooms must be a whole number from 1 to 200, not 0"),
        (("line", 201), {}, "rooms must be a whole number from 1 to 200, not 201"),
        (("line", 2.5), {}, "rooms must be a whole number from 1 to 200, not 2.5"),
        (("line", True), {}, "rooms must be"),
        (("line", "4"), {}, "rooms must be a whole number from 1 to 200, not '4'"),
        (("ring", 4, 5), {}, "furnishings must be a whole number from 1 to 4, not 5"),
        (("ring", 4, 0), {}, "furnishings must be a whole number from 1 to 4, not 0"),
        (("star", 4, 2, -1), {}, "seed must be"),
        (("star", 4, 2, 2**63), {}, "seed must be"),
        (("storeys", 4), {"storeys": 1}, "storeys must be a whole number from 2 to 20, not 1"),
        (("storeys", 2), {"storeys": 3}, "rooms must be a whole number from 3 to 200, not 2"),
        (("storeys", 12, 7), {}, r"at most 6 \(the rooms of a storey\), a multiple of that, or 12, not 7"),
        (("line",), {"bareness": 1.5}, "bareness must be a number from 0 to 1, not 1.5"),
        (("line",), {"furniture": float("nan")}, "furniture must be a number from 0 to 1, not nan"),
    ],
)
def test_mistakes(arguments: tuple[Any, ...], options: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        building(*arguments, **options)
