"""What a run found, for people: its last lines, and why something that was sought is missing."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from vsgraphs.scene_graph.kinds import KINDS, count

if TYPE_CHECKING:
    from vsgraphs.run.session import Tally

# What a run writes, in the order in which people want to know of it.
RESULT_FILES = (
    "floorplan.svg",
    "scene_graph.json",
    "trajectory.txt",
    "keyframes.txt",
    "map.ply",
    "planes.ply",
    "scene_graph.dsg.json",
    "run.json",
    "timeline.json",
)
_FEW_KEYFRAMES = 5
_LOW_SHARE = 0.8


def summarise(report: dict[str, Any], out: Path) -> str:
    """The last lines of a run: how it went, what it found, what is missing and why, where the files are.

    report: run.json's content.
    """
    startup = report["startup_s"]
    lines = [
        f"tracked {report['tracked']} of {report['frames']} frames ({100 * report['completion']:.1f} %), "
        f"{report['keyframes']} keyframes, {report['landmarks']} landmarks; {report['fps']:.1f} frames/s, "
        f"CPU {report['cpu_s']:.1f} s, {report['peak_memory_mb']:.0f} MB"
        + (f", first pose after {startup:.2f} s" if startup is not None else "")
    ]
    found = what_was_found(report["scene"])
    if found:
        lines.append(f"found {found}")
    lines += not_sought(report)
    lines += [f"warning: {line}" for line in what_is_missing(report)]
    checks = report.get("checks", {})
    lines += [f"warning: {name}: {line}" for name, found in checks.items() for line in found]
    names = (*RESULT_FILES, *report.get("exported", ()))
    files = [name for name in names if (out / name).is_file()]
    return "\n".join([*lines, f"results in {out}: {' '.join(files)}"])


_TOLD_FIRST = {name: place for place, name in enumerate(("room", "door", "plane", "floor"))}


def what_was_found(scene: dict[str, Any]) -> str:
    """As "4 rooms, 5 doors, 16 walls, 1 floor, 98 m2" (the rooms' areas); empty where nothing was found.

    scene: run.json's section of that name.
    """
    order = sorted(KINDS, key=lambda kind: _TOLD_FIRST.get(kind.name, len(_TOLD_FIRST)))
    area = f"{scene['area_m2']:.0f} m2" if scene.get("rooms") and "area_m2" in scene else ""
    return ", ".join(part for part in (*(kind.found(scene) for kind in order), area) if part)


def not_sought(report: dict[str, Any]) -> list[str]:
    """What the chosen mode leaves out: no warning, but nothing to be surprised about either."""
    mode = report["configuration"].get("system.mode")
    if mode == "slam":
        return ["no walls, no rooms: mode slam maps landmarks only; --mode full (the default) finds them"]
    if mode == "bc":
        return ["no rooms: mode bc finds walls and ground only; --mode full (the default) finds rooms"]
    return []


def what_is_missing(report: dict[str, Any]) -> list[str]:
    """What was sought and not found, why as far as is known, and what can be done; a line each.

    report: run.json's content, its warnings aside. Empty where nothing was tracked, and where the camera was
    only located in maps of earlier runs.
    """
    configuration = report["configuration"]
    if not report["tracked"] or configuration.get("system.localise_only"):
        return []
    lines = []
    if configuration.get("system.mode") != "slam":
        lines = _missing_surfaces(report)
    if lines and report["keyframes"] < _FEW_KEYFRAMES:
        lines.append(
            f"the map has only {count(report['keyframes'], 'keyframe')}: the camera hardly moved, "
            "or few frames were tracked"
        )
    return lines + _missing_frames(report)


def _missing_surfaces(report: dict[str, Any]) -> list[str]:
    """Each needs the one before: surfaces, the way up, walls and ground, rooms."""
    scene, configuration = report["scene"], report["configuration"]
    surfaces = count(scene["planes"], "flat surface")
    if not surfaces:
        reach = configuration.get("scene.extraction.max_range_m")
        within = f" nearer than {reach:g} m" if reach else ""
        return [
            f"no wall, ground or room: no flat surface was seen{within}. "
            "Check the depth images and depth_scale."
        ]
    if scene["frame"] != "levelled":
        return [
            f"no wall, ground or room: which way is up cannot be told from {surfaces}. "
            "Hold the camera upright, and show 1 m2 of floor or two walls at an angle."
        ]
    lines = []
    no_room = ", so no room" if configuration.get("system.mode") == "full" else ""
    if not scene["walls"]:
        lines.append(
            f"no wall{no_room}: of {surfaces} seen, {scene['undecided']} may be walls or not. "
            "Show walls over more than 0.8 m of their height, twice or more."
        )
    if not scene["grounds"]:
        lines.append(
            f"no ground{no_room}: heights count from the first camera. Tilt the camera to the floor."
        )
    if not lines and no_room and not scene["rooms"]:
        lines.append(_no_room(scene["walls"]))
    return lines


def _no_room(walls: int) -> str:
    if walls < 2:
        return "no room: a room takes two walls, and one was found. Turn the camera to all of them."
    return (
        f"no room: no free floor of 1.5 m2 or more was seen between the {walls} walls. "
        "Look around in the room, at its corners and its floor."
    )


def _missing_frames(report: dict[str, Any]) -> list[str]:
    lines = []
    usable = report["frames"] - sum(report["skipped"].values())
    if usable > 0 and report["tracked"] < _LOW_SHARE * usable:
        lines.append(
            f"only {100 * report['tracked'] / usable:.0f} % of the usable frames are in the results. "
            "Slower movement, more light and nearer surfaces help."
        )
    if report["maps"] > 1:
        lines.append(
            f"{report['maps']} maps were never joined, and the results hold one of them. "
            "Lead the camera back to a place it has seen."
        )
    return lines


def nothing_tracked(source: str, tally: Tally) -> str:
    """Why a run ended without a single pose, in one line."""
    unusable = tally.skipped["damaged"] + tally.skipped["stalled"] + tally.skipped["refused"]
    if tally.seen and unusable == tally.seen:
        first = tally.warnings[0].removeprefix("skipped: ") if tally.warnings else "unknown"
        return f"none of the {tally.seen} frames of {source} can be used; the first: {first}"
    return (
        f"no frame of {source} could be tracked ({tally.seen - unusable} of {tally.seen} readable): "
        "too little depth or texture to start a map; check the depth images and depth_scale"
    )
