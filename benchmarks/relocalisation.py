#!/usr/bin/env python3
"""Is a camera found again that was covered and carried off? Blacks out a sequence, then goes on elsewhere.

    benchmarks/relocalisation.py DATA/kitchen

Every other frame is mapped. Then, ten times: three seconds of darkness, and a second of the frames between at
another place. Found: a pose within that second; its error is the distance to the truth, after the mapped
trajectory was aligned with it. Serial execution; CPU times of the calling thread.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Any

import numpy as np

import vsgraphs
from vsgraphs.trajectory import read_tum_trajectory

PLACES, DARK_S, SEEN_S, MAX_ERROR_M = 10, 3.0, 1.0, 0.05


def aligned(source: np.ndarray, target: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rotation and translation that bring points (N, 3) onto others; Umeyama, PAMI 1991, without scale."""
    middle, target_middle = source.mean(0), target.mean(0)
    u, _, vt = np.linalg.svd((target - target_middle).T @ (source - middle))
    turn = u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt))]) @ vt
    return turn, target_middle - turn @ middle


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

    def carry_to(self, frames: list[Any]) -> tuple[int | None, float, float]:
        """After how many frames it is found, the error (m) and the slowest attempt (ms)."""
        for _ in range(int(DARK_S / self.step_s)):
            self.see(*self.dark)
        found, error, slowest_ms = None, float("nan"), 0.0
        for count, frame in enumerate(frames):
            rgb, depth = frame.load()
            began = time.thread_time()
            result = self.see(rgb, depth)
            if found is None:
                slowest_ms = max(slowest_ms, 1e3 * (time.thread_time() - began))
            if found is None and result.status == "relocalised":
                found = count + 1
                place = self.turn @ result.world_from_camera[:3, 3] + self.shift
                error = float(np.linalg.norm(place - self.true_place(frame.timestamp)))
        return found, error, slowest_ms


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
    seen = max(1, int(SEEN_S / camera.step_s))
    print("| from frame | found after, frames | error, mm | slowest frame, ms |\n|---|---|---|---|")
    good = 0
    for number in range(PLACES):
        begin = (number * 7 % PLACES) * len(between) // PLACES
        found, error, slowest_ms = camera.carry_to(between[begin : begin + seen])
        good += found is not None and error < MAX_ERROR_M
        print(f"| {2 * begin + 1} | {found or '-'} | {1e3 * error:.0f} | {slowest_ms:.0f} |", flush=True)
    print(f"\nfound within {SEEN_S:g} s and {100 * MAX_ERROR_M:g} cm: {good} of {PLACES}")


if __name__ == "__main__":
    main()
