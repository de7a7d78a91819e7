"""`vsgraphs info RUN_DIR`: what a run left in a directory."""

from __future__ import annotations

import json
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from vsgraphs.errors import InputError
from vsgraphs.reading import read_json, shortened
from vsgraphs.run.summary import RESULT_FILES, what_was_found
from vsgraphs.scene_graph import DoorNode, RoomNode, SceneGraph, load_scene_graph
from vsgraphs.scene_graph.kinds import count

_WARNINGS = 5  # so many are printed, the rest counted


def show_run(folder: Path, *, as_json: bool) -> None:
    """Prints it. Raises InputError where the directory holds nothing of a run, or damaged files."""
    info = describe_run(folder)
    print(json.dumps(info, indent=1) if as_json else _text(folder, info))


def describe_run(folder: Path) -> dict[str, Any]:
    """All that `info --json` tells. A run that was killed, or still goes on, has no run.json: "complete" is
    false then, and only files and rooms can be told. Raises InputError.
    """
    shown = [path for path in sorted(folder.iterdir()) if path.is_file() and not path.name.startswith(".")]
    files = {path.name: path.stat().st_size for path in shown}
    if not any(name in files for name in RESULT_FILES) and not _left_by_a_run(files):
        raise InputError(_no_run(folder, files))
    report = _report(folder) if "run.json" in files else {}
    graph = load_scene_graph(folder / "scene_graph.json") if "scene_graph.json" in files else None
    return {
        "folder": str(folder),
        "complete": bool(report),
        "ended": _ended(folder, report) if report else None,
        **{key: report[key] for key in _FIGURES if key in report},
        "mode": report.get("configuration", {}).get("system.mode"),
        "rooms": [_room(graph, room) for room in graph.rooms.values()] if graph else None,
        "warnings": report.get("warnings", []),
        "files": files,
    }


_FIGURES = (
    *("source", "versions", "commit", "interrupted", "frames", "tracked", "completion", "skipped"),
    *("keyframes", "landmarks", "maps", "loops", "merges", "scene", "wall_s", "fps", "cpu_s"),
    "peak_memory_mb",
)


def _left_by_a_run(files: dict[str, int]) -> bool:
    """What a run that did not end leaves: its atlas and its recording."""
    return any(name.endswith((".vsg", ".rrd")) for name in files)


def _no_run(folder: Path, files: dict[str, int]) -> str:
    if not files and (folder / ".lock").exists():
        return f"{folder}: a run is under way here, or was killed; it writes its files when it ends"
    if not files and not any(folder.iterdir()):
        return f"{folder} is empty: a run writes its files when it ends"
    from vsgraphs.datasets import CAMERAS, open_sequence

    try:
        found = open_sequence(folder, CAMERAS["tum-fr3"])  # any camera: no image is read
    except InputError:
        return f"{folder} holds no run: none of {', '.join(RESULT_FILES[:3])}, run.json is there"
    return f"{folder} is a {found.format} sequence, not a run's results: `vsgraphs run {folder}` makes them"


def _report(folder: Path) -> dict[str, Any]:
    path = folder / "run.json"
    report = read_json(path, "figures of a run")
    if not isinstance(report, dict) or any(not isinstance(report.get(k), t) for k, t in _EXPECTED.items()):
        raise InputError(f"{path}: not the run.json of a vsgraphs run")
    return report


# Of every version.
_EXPECTED = {
    "frames": int,
    "tracked": int,
    "completion": int | float,
    "keyframes": int,
    "maps": int,
    "loops": int,
    "scene": dict,
    "source": dict,
    "versions": dict,
    "configuration": dict,
    "warnings": list,
}


def _ended(folder: Path, report: dict[str, Any]) -> str:
    """ISO 8601; of runs that do not tell, when the file was written."""
    try:
        ended = datetime.fromisoformat(report["ended"])
    except (KeyError, TypeError, ValueError):
        ended = datetime.fromtimestamp((folder / "run.json").stat().st_mtime, UTC)
    return ended.isoformat(timespec="seconds")


def _room(graph: SceneGraph, room: RoomNode) -> dict[str, Any]:
    doors = [door for door in graph.doors.values() if room.id in door.rooms]
    return {
        "id": room.id,
        "name": room.name or f"{room.kind} {room.id}",
        "area_m2": room.area_m2,
        "height_m": room.height_m,
        "partial": room.partial,
        "walls": len(room.walls),
        "floor": room.floor,
        "doors": [_door(graph, door, room.id) for door in doors],
    }


def _door(graph: SceneGraph, door: DoorNode, here: int) -> dict[str, Any]:
    other = next((room for room in door.rooms if room is not None and room != here), None)
    behind = graph.rooms.get(other) if other is not None else None
    name = None if behind is None else behind.name or f"{behind.kind} {behind.id}"
    return {"id": door.id, "name": door.name, "kind": door.kind, "width_m": door.width_m, "to": name}


# ---- for people


def _text(folder: Path, info: dict[str, Any]) -> str:
    lines = _head(folder, info) if info["complete"] else [_incomplete(folder, info)]
    if info["rooms"]:
        lines += ["", *_rooms(info["rooms"])]
    if info["warnings"]:
        more = len(info["warnings"]) - _WARNINGS
        lines += ["", count(len(info["warnings"]), "warning") + ":"]
        lines += [f"  {shortened(str(line), 300)}" for line in info["warnings"][:_WARNINGS]]
        lines += [f"  and {more} more in run.json"] if more > 0 else []
    return "\n".join([*lines, "", *_files(info["files"])])


def _head(folder: Path, info: dict[str, Any]) -> list[str]:
    source, versions = info["source"], info["versions"]
    ended = datetime.fromisoformat(info["ended"]).astimezone()
    counts = [count(info["keyframes"], "keyframe"), count(info["loops"], "loop"), count(info["maps"], "map")]
    return [
        f"{folder}: run of {source.get('name', 'an unknown sequence')} ({source.get('format', 'unknown')}), "
        f"{'interrupted' if info.get('interrupted') else 'ended'} {ended:%Y-%m-%d %H:%M}",
        f"made by vsgraphs {versions.get('vsgraphs', 'of unknown version')}, commit "
        f"{info.get('commit', 'unknown')}, mode {info['mode'] or 'unknown'}",
        f"tracked {info['tracked']} of {info['frames']} frames ({100 * info['completion']:.1f} %): "
        + ", ".join(part for part in counts if part),
        f"found {what_was_found(info['scene']) or 'no walls, no rooms'}",
    ]


def _incomplete(folder: Path, info: dict[str, Any]) -> str:
    atlases = [name for name in info["files"] if name.endswith(".vsg")]
    hint = f"; `vsgraphs info {folder / atlases[0]}` tells of its saved maps" if atlases else ""
    return f"{folder}: no run.json: the run was killed, or it has not ended yet{hint}"


def _rooms(rooms: list[dict[str, Any]]) -> list[str]:
    width = max(4, *(len(room["name"]) for room in rooms))
    lines = [f"{'room':{width}}  {'area':>9}  {'walls':>5}  doors to"]
    for room in rooms:
        doors = ", ".join(door["to"] or "what was not seen" for door in room["doors"]) or "none"
        partly = "; partly seen" if room["partial"] else ""
        lines.append(
            f"{room['name']:{width}}  {room['area_m2']:>6.1f} m2  {room['walls']:>5}  {doors}{partly}"
        )
    return lines


def _files(files: dict[str, int]) -> list[str]:
    """The run's own in their order, then what else lies there."""
    names = [name for name in RESULT_FILES if name in files]
    names += [name for name in files if name not in names]
    width = max((len(name) for name in names), default=0)
    return [f"{name:{width}}  {_size(files[name]):>9}" for name in names]


def _size(number: int) -> str:
    if number < 1e6:
        return f"{number / 1e3:.1f} kB"
    return f"{number / 1e6:.1f} MB"
