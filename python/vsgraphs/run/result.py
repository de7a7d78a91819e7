"""What a run came to."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from vsgraphs.errors import InputError
from vsgraphs.reading import read_json
from vsgraphs.scene_graph import SceneGraph, load_scene_graph
from vsgraphs.trajectory import Trajectory, read_tum_trajectory


@dataclass(eq=False)
class Result:
    """A finished run. All coordinates are those of the files: levelled where the scene graph is.

    folder: where the files are. trajectory: every tracked frame; keyframes: the same for keyframes; seconds,
    (N, 4, 4) world_from_camera, metres. scene_graph: None in mode slam. info: run.json's content. files:
    those written, by name. failure: what kept a part of it from being done or written; `vsgraphs.run` raises
    it.
    """

    folder: Path
    trajectory: Trajectory
    keyframes: Trajectory
    scene_graph: SceneGraph | None
    info: dict[str, Any] = field(default_factory=dict)
    files: dict[str, Path] = field(default_factory=dict)
    failure: Exception | None = None

    @classmethod
    def load(cls, folder: Path | str) -> Result:
        """Of a directory that an earlier run left. Raises InputError where it is none, or damaged."""
        folder = Path(folder)
        info = read_json(folder / "run.json", "figures of a run")
        if not isinstance(info, dict) or not isinstance(info.get("tracked"), int):
            raise InputError(f"{folder / 'run.json'}: not the run.json of a vsgraphs run")
        trajectory = read_tum_trajectory(folder / "trajectory.txt")
        keyframes = read_tum_trajectory(folder / "keyframes.txt")
        graph = folder / "scene_graph.json"
        scene_graph = load_scene_graph(graph) if graph.is_file() else None
        files = {path.name: path for path in sorted(folder.iterdir()) if path.is_file()}
        return cls(folder, trajectory, keyframes, scene_graph, info, files)

    @property
    def statuses(self) -> dict[str, int]:
        """How many frames had each status ("ok", "lost", ...) or were skipped for each reason ("damaged",
        "dropped", ...).
        """
        return {**self.info.get("statuses", {}), **self.info.get("skipped", {})}

    @property
    def warnings(self) -> list[str]:
        """What a person should know, a line each."""
        return list(self.info.get("warnings", []))

    @property
    def interrupted(self) -> bool:
        """Whether it was ended before its source was."""
        return bool(self.info.get("interrupted"))

    def __repr__(self) -> str:
        info, rooms = self.info, len(self.scene_graph.rooms) if self.scene_graph else 0
        return (
            f"Result({str(self.folder)!r}, {info.get('tracked', 0)} of {info.get('frames', 0)} frames, "
            f"{len(self.keyframes)} keyframes, {rooms} rooms, {len(self.warnings)} warnings)"
        )
