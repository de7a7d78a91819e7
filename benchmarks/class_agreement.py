#!/usr/bin/env python3
"""Do two runs of one sequence call the same pixels wall and ground? For a network against geometry.

    vsgraphs run FOLDER --execution serial --segmenter onnx:model.onnx --out network
    vsgraphs run FOLDER --execution serial --out geometry
    benchmarks/class_agreement.py FOLDER network geometry

Of every keyframe of the first run each eighth pixel with depth is put into both maps, by each run's own
pose, and takes the role of the mapped plane it lies on (within 5 cm, and on an observed cell). So roles are
compared after the votes of all keyframes. Precision and recall are of pixels on which both have an opinion.
Where FOLDER has labels.txt, the first run is compared with them too.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

import vsgraphs
from vsgraphs.lens import depth_metres, undistort
from vsgraphs.scene_graph import SceneGraph, load_scene_graph
from vsgraphs.segment import SurfaceRole
from vsgraphs.segment.label_folder import LabelFolder
from vsgraphs.trajectory import Trajectory, read_tum_trajectory

Array = npt.NDArray[np.float64]
STEP_PX, MAX_DISTANCE_M, MAX_RANGE_M, TIME_TOLERANCE_S = 8, 0.05, 6.0, 1e-4
ROLES = ("wall", "ground")
NO_OPINION = ("none", "undecided")


class Run:
    """A finished run: its planes, and where its camera was."""

    def __init__(self, folder: Path) -> None:
        self.graph: SceneGraph = load_scene_graph(folder / "scene_graph.json")
        self.trajectory: Trajectory = read_tum_trajectory(folder / "trajectory.txt")
        self.cells = {plane.id: self._widened(plane.extent.cells()) for plane in self.graph.planes.values()}

    @staticmethod
    def _widened(cells: npt.NDArray[np.int64]) -> set[tuple[int, int]]:
        """Occupied cells and those beside them: a pixel's point wanders by its depth's noise."""
        return {(int(u) + du, int(v) + dv) for u, v in cells for du in (-1, 0, 1) for dv in (-1, 0, 1)}

    def roles(self, points: Array, timestamp: float) -> npt.NDArray[np.str_] | None:
        """Role of the nearest plane under each of (N, 3) points of the camera, or "none"; None: no pose."""
        times = self.trajectory.timestamps
        at = int(np.argmin(np.abs(times - timestamp)))
        if abs(times[at] - timestamp) > TIME_TOLERANCE_S:
            return None
        pose = self.trajectory.poses[at]
        world = points @ pose[:3, :3].T + pose[:3, 3]
        best = np.full(len(world), MAX_DISTANCE_M)
        found = np.full(len(world), "none", dtype="U12")
        for plane in self.graph.planes.values():
            distance = np.abs(world @ plane.normal + plane.offset_m)
            near = np.flatnonzero(distance < best)
            flat = np.floor(plane.extent.flat(world[near]) / plane.extent.cell_m).astype(int)
            inside = near[[(u, v) in self.cells[plane.id] for u, v in flat.tolist()]] if len(near) else near
            best[inside] = distance[inside]
            found[inside] = plane.role
        return found


class Agreement:
    """Pixels that one side, the other and both give a role, where both decide; and the first alone."""

    def __init__(self) -> None:
        self.mine, self.other, self.both, self.alone = (dict.fromkeys(ROLES, 0) for _ in range(4))

    def add(self, mine: npt.NDArray[np.str_], other: npt.NDArray[np.str_]) -> None:
        """Counts one image's pixels."""
        silent = np.isin(other, NO_OPINION)
        for role in ROLES:
            self.mine[role] += int(np.count_nonzero((mine == role) & ~silent))
            self.other[role] += int(np.count_nonzero((other == role) & ~np.isin(mine, NO_OPINION)))
            self.both[role] += int(np.count_nonzero((mine == role) & (other == role)))
            self.alone[role] += int(np.count_nonzero((mine == role) & silent))

    def tell(self, name: str) -> None:
        """Prints a row for each role."""
        for role in ROLES:
            precision = self.both[role] / max(self.mine[role], 1)
            recall = self.both[role] / max(self.other[role], 1)
            counts = f"{self.mine[role]} | {self.alone[role]}"
            print(f"| {name} | {role} | {counts} | {precision:.3f} | {recall:.3f} |")


def sampled_points(depth: Any, camera: Any) -> tuple[Array, tuple[Any, Any]]:
    """Points (N, 3) of each eighth pixel in range, in the camera; and the pixels' rows and columns."""
    rows, columns = np.meshgrid(
        np.arange(0, depth.shape[0], STEP_PX), np.arange(0, depth.shape[1], STEP_PX), indexing="ij"
    )
    z = depth_metres(depth, camera)[rows, columns].astype(np.float64)
    seen = (z > 0) & (z < MAX_RANGE_M)
    z, rows, columns = z[seen], rows[seen], columns[seen]
    x, y = undistort(camera, columns, rows)
    points = np.stack([x * z, y * z, z], axis=1)
    return points, (rows, columns)


def main() -> None:
    """Reads the arguments, prints the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("sequence", type=Path)
    parser.add_argument("run", type=Path, help="the run that is judged")
    parser.add_argument("reference", type=Path, help="the run it is compared with")
    given = parser.parse_args()
    sequence = vsgraphs.open_sequence(given.sequence)
    run, reference = Run(given.run), Run(given.reference)
    labels = LabelFolder(given.sequence) if (given.sequence / "labels.txt").is_file() else None
    with_reference, with_labels = Agreement(), Agreement()
    frames = np.array([frame.timestamp for frame in sequence.frames])
    for keyframe in run.graph.keyframes.values():
        at = int(np.argmin(np.abs(frames - keyframe.timestamp_s)))
        points, pixels = sampled_points(sequence.frames[at].load()[1], sequence.camera)
        mine = run.roles(points, keyframe.timestamp_s)
        other = reference.roles(points, keyframe.timestamp_s)
        if mine is None or other is None:
            continue
        with_reference.add(mine, other)
        truth = labels.at(keyframe.timestamp_s) if labels else None
        if truth is not None:
            names = np.array([role.name.lower() for role in SurfaceRole])
            with_labels.add(mine, names[truth.roles[pixels]])
    print("| against | role | both decide | first alone | precision | recall |\n|---|---|---|---|---|---|")
    with_reference.tell(str(given.reference))
    if labels:
        with_labels.tell("labels.txt")


if __name__ == "__main__":
    main()
