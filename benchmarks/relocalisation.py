#!/usr/bin/env python3
"""Is a camera found again that was covered and carried off? Blacks out a sequence, then goes on elsewhere.

    benchmarks/relocalisation.py DATA/kitchen

Every other frame is mapped. Then, ten times: three seconds of darkness, and a second of the frames between at
another place. Found: a pose within that second. Its error is told twice: off the map, the distance to where
the map has that instant, between the mapped frames before and after it; and off the truth, after the mapped
trajectory was aligned with it, which holds the map's own error too. Serial execution; CPU times of the
calling thread.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import vsgraphs
from vsgraphs.trajectory import Trajectory, read_tum_trajectory

PLACES, DARK_S, SEEN_S, MAX_ERROR_M = 10, 3.0, 1.0, 0.05


def aligned(source: np.ndarray, target: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rotation and translation that bring points (N, 3) onto others; Umeyama, PAMI 1991, without scale."""
    middle, target_middle = source.mean(0), target.mean(0)
    u, _, vt = np.linalg.svd((target - target_middle).T @ (source - middle))
    turn = u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt))]) @ vt
    return turn, target_middle - turn @ middle


def true_positions(truth: Trajectory, stamps: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which stamps the truth covers (bool), and where the camera was then (N, 3)."""
    within = (stamps >= truth.timestamps[0]) & (stamps <= truth.timestamps[-1])
    axes = [np.interp(stamps[within], truth.timestamps, truth.positions[:, i]) for i in range(3)]
    return within, np.column_stack(axes)


def rmse_mm(positions: np.ndarray, true: np.ndarray, alignment: tuple[np.ndarray, np.ndarray]) -> float:
    """Of positions (N, 3) in m, once aligned."""
    turn, shift = alignment
    off_m = np.linalg.norm(positions @ turn.T + shift - true, axis=1)
    return float(1e3 * np.sqrt(np.mean(off_m**2)))


@dataclass
class Recovery:
    """How it went at one place."""

    found: int | None = None  # after so many frames
    off_map_m: float = float("nan")
    off_truth_m: float = float("nan")
    slowest_ms: float = 0.0  # attempt

    def row(self, frame: int) -> str:
        """Of the table."""
        found = "-" if self.found is None else str(self.found)
        millimetres = f"{1e3 * self.off_map_m:.0f} | {1e3 * self.off_truth_m:.0f}"
        return f"| {frame} | {found} | {millimetres} | {self.slowest_ms:.0f} |"


class Carried:
    """A camera with its clock, and the truth."""

    def __init__(self, sequence: Any, truth: Any) -> None:
        config = vsgraphs.Config()
        config.set("system.execution", "serial")
        self.slam = vsgraphs.Slam(config, sequence.camera)
        self.truth = truth
        self.step_s = 2.0 / sequence.camera.fps
        self.frames = 0
        self.turn, self.shift = np.eye(3), np.zeros(3)

    def see(self, rgb: np.ndarray, depth: np.ndarray) -> Any:
        """The next frame."""
        self.frames += 1
        return self.slam.track(rgb, depth, (self.frames - 1) * self.step_s)

    def true_place(self, timestamp: float) -> np.ndarray:
        """Where the camera was, m."""
        places = self.truth.positions
        return np.array([np.interp(timestamp, self.truth.timestamps, places[:, i]) for i in range(3)])

    def map(self, frames: list[Any]) -> None:
        """Walks through the frames and aligns what came out with the truth."""
        for frame in frames:
            rgb, depth = frame.load()
            self.see(rgb, depth)
        self.dark = np.zeros_like(rgb), np.zeros_like(depth)
        stamps, poses = self.slam.trajectory()
        seen = [frames[round(stamp / self.step_s)].timestamp for stamp in stamps]
        self.turn, self.shift = aligned(poses[:, :3, 3], np.array([self.true_place(s) for s in seen]))

    def mapped_place(self, instant: float) -> np.ndarray:
        """Where the map has the camera at an instant of its own clock while it mapped, m."""
        stamps, poses = self.slam.trajectory()
        return np.array([np.interp(instant, stamps, poses[:, i, 3]) for i in range(3)])

    def carry_to(self, frames: list[Any], instants: list[float]) -> Recovery:
        """Darkness, then the frames, which lie at these instants of the clock while it mapped."""
        for _ in range(int(DARK_S / self.step_s)):
            self.see(*self.dark)
        recovery = Recovery()
        for count, (frame, instant) in enumerate(zip(frames, instants, strict=True)):
            rgb, depth = frame.load()
            began = time.thread_time()
            result = self.see(rgb, depth)
            if recovery.found is not None:
                continue
            recovery.slowest_ms = max(recovery.slowest_ms, 1e3 * (time.thread_time() - began))
            if result.status == "relocalised":
                recovery.found = count + 1
                place = result.world_from_camera[:3, 3]
                recovery.off_map_m = float(np.linalg.norm(place - self.mapped_place(instant)))
                aligned_place = self.turn @ place + self.shift
                off_truth = aligned_place - self.true_place(frame.timestamp)
                recovery.off_truth_m = float(np.linalg.norm(off_truth))
        return recovery


def instants_between(frames: list[Any], step_s: float) -> list[float]:
    """When every second frame was, on a clock that counts only the others, `step_s` apart."""
    instants = []
    for i in range(1, len(frames), 2):
        before, here = frames[i - 1].timestamp, frames[i].timestamp
        after = frames[i + 1].timestamp if i + 1 < len(frames) else 2 * here - before
        instants.append((i // 2 + (here - before) / (after - before)) * step_s)
    return instants


def main() -> None:
    """Prints a Markdown table, one row a place."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("sequence", type=Path)
    sequence_folder = parser.parse_args().sequence

    sequence = vsgraphs.open_sequence(sequence_folder)
    camera = Carried(sequence, read_tum_trajectory(sequence_folder / "groundtruth.txt"))
    camera.map(sequence.frames[::2])
    between = sequence.frames[1::2]
    instants = instants_between(sequence.frames, camera.step_s)
    seen = max(1, int(SEEN_S / camera.step_s))
    print("| from frame | found after, frames | off the map, mm | off the truth, mm | slowest attempt, ms |")
    print("|---|---|---|---|---|")
    done = []
    for number in range(PLACES):
        begin = (number * 7 % PLACES) * len(between) // PLACES
        done.append(camera.carry_to(between[begin : begin + seen], instants[begin : begin + seen]))
        print(done[-1].row(2 * begin + 1), flush=True)
    near_map = sum(r.off_map_m < MAX_ERROR_M for r in done)
    near_truth = sum(r.off_truth_m < MAX_ERROR_M for r in done)
    print(
        f"\nof {PLACES} places, found within {SEEN_S:g} s: {sum(r.found is not None for r in done)}, "
        f"within {100 * MAX_ERROR_M:g} cm of the map: {near_map}, of the truth: {near_truth}; "
        f"slowest attempt {max(r.slowest_ms for r in done):.0f} ms"
    )


if __name__ == "__main__":
    main()
