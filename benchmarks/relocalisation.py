#!/usr/bin/env python3
"""Is a camera found again that was covered and carried off? Blacks a sequence out and goes on at ten other places.

    benchmarks/relocalisation.py DATA/kitchen

Every other frame is mapped. Then, ten times: three seconds of darkness, and a second of the frames between at another
place. Found: a pose within that second; its error is the distance to the truth, after the mapped trajectory was
aligned with it (or, without truth, to the mapped trajectory itself). Serial execution; times are of the CPU.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np

import vsgraphs
from vsgraphs.trajectory import Trajectory

PLACES, DARK_S, SEEN_S, MAX_ERROR_M = 10, 3.0, 1.0, 0.05


def aligned(source: np.ndarray, target: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rotation and translation that bring points (N, 3) onto others; Umeyama, PAMI 1991, without scale."""
    middle, target_middle = source.mean(0), target.mean(0)
    u, _, vt = np.linalg.svd((target - target_middle).T @ (source - middle))
    turn = u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt))]) @ vt
    return turn, target_middle - turn @ middle


def main() -> None:
    """Prints a Markdown table, one row a place."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("sequence", type=Path)
    parser.add_argument("--set", action="append", default=[], metavar="KEY=NUMBER")
    options = parser.parse_args()

    sequence = vsgraphs.open_sequence(options.sequence)
    truth = Trajectory.read(options.sequence / "groundtruth.txt")
    config = vsgraphs.Config()
    config.set("system.execution", "serial")
    for item in options.set:
        key, _, value = item.partition("=")
        config.set(key, type(config.get(key))(value))
    slam = vsgraphs.Slam(config, sequence.camera)
    step_s = 2.0 / sequence.camera.fps
    now, stamp_of = 0.0, {}
    for frame in sequence.frames[::2]:
        rgb, depth = frame.load()
        slam.track(rgb, depth, now)
        stamp_of[now] = frame.timestamp
        now += step_s
    dark_rgb, dark_depth = np.zeros_like(rgb), np.zeros_like(depth)

    stamps, poses = slam.trajectory()
    mapped = np.array([p[:3, 3] for p in poses])
    true_stamps, true_places = truth.timestamps, truth.positions

    def true_place(timestamp: float) -> np.ndarray:
        return np.array([np.interp(timestamp, true_stamps, true_places[:, axis]) for axis in range(3)])

    turn, shift = aligned(mapped, np.array([true_place(stamp_of[s]) for s in stamps]))
    print("| place | found after, frames | error, mm | slowest attempt, ms |")
    print("|---|---|---|---|")
    good = 0
    between = sequence.frames[1::2]
    for number in range(PLACES):
        begin = (number * 7 % PLACES) * len(between) // PLACES
        for _ in range(int(DARK_S / step_s)):
            slam.track(dark_rgb, dark_depth, now)
            now += step_s
        found, error, slowest = None, float("nan"), 0.0
        for count, frame in enumerate(between[begin : begin + max(1, int(SEEN_S / step_s))]):
            rgb, depth = frame.load()
            began = time.thread_time()
            result = slam.track(rgb, depth, now)
            if found is None:
                slowest = max(slowest, 1e3 * (time.thread_time() - began))
            now += step_s
            if found is None and result.status == "relocalised":
                found = count + 1
                place = turn @ result.world_from_camera[:3, 3] + shift
                error = float(np.linalg.norm(place - true_place(frame.timestamp)))
        good += found is not None and error < MAX_ERROR_M
        print(f"| {begin} | {found or '-'} | {1e3 * error:.0f} | {slowest:.0f} |", flush=True)
    print(f"\nfound within {SEEN_S:g} s and {100 * MAX_ERROR_M:g} cm: {good} of {PLACES}")


if __name__ == "__main__":
    main()
