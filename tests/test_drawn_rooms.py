"""Drawn flats and offices: each can be built and walked, has what makes it hard, and says so in its truth."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from conftest import Program, one_line_error

from vsgraphs.compiled import core
from vsgraphs.errors import InputError
from vsgraphs.plans import DRAWN_KINDS, drawn, load_plan
from vsgraphs.simulate import Output, simulate

SEEDS = range(8)
SMALL = {"width": 96, "height": 72, "fx": 78.75, "fy": 78.75, "cx": 47.5, "cy": 35.5}


@pytest.mark.parametrize("kind", DRAWN_KINDS)
@pytest.mark.parametrize("carrier", ["hand", "robot"])
def test_every_seed_can_be_built_and_walked(kind: str, carrier: str) -> None:
    if kind in ("desk", "kitchen") and carrier == "robot":
        pytest.skip("seen from the hand")
    for seed in SEEDS[::2]:
        scene = core().build_scene(load_plan(drawn(kind, seed, carrier=carrier)).plan)
        assert 15 < scene.duration_s < 400, seed


def test_a_desk_is_seen_from_the_hand() -> None:
    with pytest.raises(InputError, match="a drawn desk is seen from the hand"):
        drawn("desk", 1, carrier="robot")


def test_pairs_of_doors_and_steps_reach_the_sizes_there_are() -> None:
    plans = [drawn(kind, seed) for kind in ("flat", "office") for seed in range(30)]
    widths = [d["width"] for p in plans for d in p["doors"] if d.get("leaf", {}).get("pair")]
    steps = {room["z_floor"] for p in plans for room in p["rooms"] if "z_floor" in room}
    assert 2.3 < max(widths) <= 2.5
    assert min(widths) < 1.8
    assert steps == {0.0, 0.1, 0.18, 0.3, 0.4}


def test_equal_arguments_equal_plans() -> None:
    assert drawn("flat", 3) == drawn("flat", 3)
    assert drawn("flat", 3) != drawn("flat", 4)


def found(kind: str) -> set[str]:
    """What some seed of a kind has."""
    names: set[str] = set()
    for seed in SEEDS:
        plan = drawn(kind, seed)
        names |= {f"partition {item['kind']}" for item in plan.get("partitions", []) if "kind" in item}
        names |= {f"window {item['view']}" for item in plan["windows"]}
        names |= {item["kind"] for item in plan["posters"] if item["kind"] == "mirror"}
        names |= {item["kind"] for item in plan["boxes"] if item["kind"] == "pillar"}
        names |= {item.get("pose", item["kind"]) for item in plan.get("movers", [])}
        names |= {"curtain" for item in plan["windows"] if item["curtain"]}
        for room in plan["rooms"]:
            names |= {key for key in ("slope",) if key in room}
            names |= {"round"} if len(room["polygon"]) > 12 else set()
            names |= {"alcove"} if len(room["polygon"]) == 8 else set()
            names |= {"dark"} if room.get("brightness", 1) < 0.4 else set()
            names |= {"step"} if room.get("z_floor", 0) > 0 else set()
        heights = {room["id"]: room["height"] for room in plan["rooms"]}
        for door in plan["doors"]:
            leaf = door.get("leaf", {})
            names |= {key for key in ("set_back", "pair", "turns") if key in leaf}
            names |= {"ajar"} if 10 < leaf.get("angle_deg", 0) < 75 else set()
            lowest = min(heights[room] for room in door["rooms"])
            names |= {"up to the ceiling"} if door["height"] > lowest - 0.05 else set()
    return names


def test_flats_and_offices_have_what_is_hard() -> None:
    doors = {"set_back", "pair", "turns", "ajar", "up to the ceiling"}
    assert found("flat") >= doors | {
        "partition glass", "window street", "window parapet", "mirror", "slope", "round", "alcove", "dark",
        "step", "curtain", "sit", "stand", "person",
    }  # fmt: skip
    assert found("office") >= doors | {"partition glass", "pillar", "sit", "trolley", "window street"}


def test_the_truth_lists_them(tmp_path: Path) -> None:
    plan: dict[str, Any] = {**drawn("flat", 1), "camera": SMALL}
    simulate(plan, tmp_path / "a", sensor="clean", frames=3, output=Output(every=40, labels_every=1))
    truth = json.loads((tmp_path / "a" / "scene_gt.json").read_text())
    for key in ("mirrors", "partitions", "movers"):
        assert len(truth.get(key, [])) == len(
            [p for p in plan["posters"] if p["kind"] == "mirror"] if key == "mirrors" else plan.get(key, [])
        )
    classes = {item["id"]: item["cls"] for item in truth["instances"]}
    assert {classes[mirror["inst"]] for mirror in truth["mirrors"]} == {"mirror"}
    assert {classes[mover["inst"]] for mover in truth["movers"]} <= {"person", "misc"}
    assert any("slope" in room for room in truth["rooms"])
    assert {window["view"] for window in truth["windows"]} <= {"street", "parapet"}


def test_the_command_draws_rooms(tmp_path: Path, vsgraphs: Program) -> None:
    file = tmp_path / "flat.json"
    done = vsgraphs("simulate", "--drawn", "flat", "--seed", 2, "--robot", "--plan-only", file)
    assert done.returncode == 0, done.stderr
    assert json.loads(file.read_text()) == drawn("flat", 2, carrier="robot")
    for options, message in (
        (["--drawn", "villa"], "drawn must be one of flat, office"),
        (["--drawn", "flat", "--rooms", 3], "--rooms goes with --building, not with --drawn"),
        (["demo", "--drawn", "flat"], "give either the plan demo or --drawn flat"),
        (["demo", "--robot"], "--robot goes with --drawn"),
    ):
        done = vsgraphs("simulate", *options, "--plan-only", tmp_path / "x.json")
        assert message in one_line_error(done)


def test_wrong_arguments() -> None:
    with pytest.raises(InputError, match="seed must be a whole number"):
        drawn("flat", -1)
    with pytest.raises(InputError, match="carrier must be one of hand, robot"):
        drawn("flat", 1, carrier="drone")
