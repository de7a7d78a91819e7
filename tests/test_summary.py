"""What a run says at its end: what was found, and why something is missing."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from vsgraphs.run.summary import summarise, what_is_missing, what_was_found

ROOMS = {
    "frame": "levelled",
    "planes": 30,
    "undecided": 7,
    "walls": 16,
    "grounds": 1,
    "rooms": 4,
    "partial_rooms": 0,
    "area_m2": 97.6,
    "floors": 1,
    "doors": 5,
}
NOTHING = {"walls": 0, "grounds": 0, "rooms": 0, "area_m2": 0.0, "floors": 0, "doors": 0}


def run(scene: dict[str, Any] | None = None, **more: Any) -> dict[str, Any]:
    """A run.json's content; `scene`: what is otherwise than in a run that found everything."""
    settings = {"system.mode": "full", "system.localise_only": False, "scene.extraction.max_range_m": 5.0}
    return {
        "frames": 600,
        "tracked": 600,
        "completion": 1.0,
        "skipped": {},
        "maps": 1,
        "keyframes": 80,
        "landmarks": 9000,
        "fps": 60.0,
        "cpu_s": 9.0,
        "peak_memory_mb": 120.0,
        "startup_s": 0.4,
        "scene": {**ROOMS, **(scene or {})},
        "configuration": {**settings, "system.mode": more.pop("mode", "full")},
        **more,
    }


def test_the_last_lines(tmp_path: Path) -> None:
    for name in ("run.json", "trajectory.txt", "scene_graph.json", "floorplan.svg"):
        (tmp_path / name).touch()
    tracked, found, files = summarise(run(), tmp_path).splitlines()
    assert tracked.startswith("tracked 600 of 600 frames (100.0 %), 80 keyframes")
    assert found == "found 4 rooms, 5 doors, 16 walls, 1 floor, 98 m2"
    assert files == f"results in {tmp_path}: floorplan.svg scene_graph.json trajectory.txt run.json"


@pytest.mark.parametrize(
    ("scene", "text"),
    [
        (
            {"rooms": 1, "doors": 1, "walls": 1, "floors": 2, "area_m2": 1.4},
            "1 room, 1 door, 1 wall, 2 floors, 1 m2",
        ),
        ({"partial_rooms": 1, "doors": 0}, "4 rooms (1 partly seen), 16 walls, 1 floor, 98 m2"),
        ({"rooms": 2, "partial_rooms": 2}, "2 rooms (partly seen), 5 doors, 16 walls, 1 floor, 98 m2"),
        ({**NOTHING, "walls": 3, "grounds": 2}, "3 walls, 2 ground planes"),
        ({**NOTHING, "grounds": 1}, "1 ground plane"),
        (NOTHING, ""),
    ],
)
def test_plural_forms_and_zeros(scene: dict[str, Any], text: str) -> None:
    assert what_was_found({**ROOMS, **scene}) == text


def test_runs_of_older_versions_have_no_areas() -> None:
    assert what_was_found({"planes": 3, "walls": 2, "rooms": 1, "floors": 1}) == "1 room, 2 walls, 1 floor"
    assert what_was_found({"frame": "first_camera"}) == ""


BLIND = run({**NOTHING, "planes": 0, "undecided": 0, "frame": "first_camera"})
TILTED = run({**NOTHING, "planes": 1, "undecided": 1, "frame": "first_camera"})


@pytest.mark.parametrize(
    ("report", "beginnings"),
    [
        (run(), []),
        (BLIND, ["no wall, ground or room: no flat surface was seen nearer than 5 m. Check the depth"]),
        (TILTED, ["no wall, ground or room: which way is up cannot be told from 1 flat surface. Hold the"]),
        (run({**NOTHING, "grounds": 1}), ["no wall, so no room: of 30 flat surfaces seen, 7 may be walls"]),
        (run({**NOTHING, "walls": 3}), ["no ground, so no room: heights count from the first camera. Tilt"]),
        (run({**NOTHING, "walls": 3}, mode="bc"), ["no ground: heights"]),
        (run(NOTHING), ["no wall, so no room", "no ground, so no room"]),
        (run({**NOTHING, "walls": 1, "grounds": 1}), ["no room: a room takes two walls, and one was found"]),
        (run({**NOTHING, "walls": 3, "grounds": 1}), ["no room: no free floor of 1.5 m2 or more was seen"]),
        (run({**NOTHING, "walls": 3, "grounds": 1}, keyframes=1), ["no room", "the map has only 1 keyframe"]),
        (run({**NOTHING, "walls": 3, "grounds": 1}, mode="bc"), []),
        (run(keyframes=1), []),
        (run(tracked=300), ["only 50 % of the usable frames"]),
        (run(tracked=300, skipped={"dropped": 290}), []),
        (run(maps=2), ["2 maps were never joined"]),
        (run(NOTHING, tracked=0, keyframes=0), []),
    ],
)
def test_what_is_missing(report: dict[str, Any], beginnings: list[str]) -> None:
    lines = what_is_missing(report)
    assert len(lines) == len(beginnings), lines
    for line, beginning in zip(lines, beginnings, strict=True):
        assert line.startswith(beginning)
        assert "\n" not in line


def test_localising_only_misses_nothing() -> None:
    report = run({**NOTHING, "walls": 1}, tracked=100)
    report["configuration"]["system.localise_only"] = True
    assert what_is_missing(report) == []


@pytest.mark.parametrize(
    ("mode", "said"), [("slam", "mode slam maps landmarks only"), ("bc", "no rooms: mode bc")]
)
def test_what_a_mode_leaves_out_is_no_warning(mode: str, said: str, tmp_path: Path) -> None:
    scene = {"frame": "first_camera"} if mode == "slam" else {**ROOMS, **NOTHING, "walls": 2, "grounds": 1}
    report = {**run(mode=mode), "scene": scene}
    assert what_is_missing(report) == []
    lines = summarise(report, tmp_path).splitlines()
    assert any(line.startswith("no ") and said in line and "--mode full" in line for line in lines)
    assert not any(line.startswith("warning") for line in lines)


def test_what_is_missing_is_told_as_a_warning(tmp_path: Path) -> None:
    assert "\nwarning: no ground, so no room: " in summarise(run({"grounds": 0}), tmp_path)
