#!/usr/bin/env python3
"""Does the adjustment of the whole map after a loop block tracking? Times of frames during it and otherwise.

    benchmarks/adjustment_blocking.py DATA/three_rooms --runs 3
    chrt -r 1 benchmarks/adjustment_blocking.py DATA/three_rooms     # where the machine does other work too

Threaded, at the camera's pace (--fps), frames decoded before they are due. A frame's time is that of
`track()` with every wait; its wait is what of that time the caller's thread did not compute: locks, and other
threads on its processor. A frame counts to an adjustment if the two overlap.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import vsgraphs
from vsgraphs.datasets import RecordedSequence
from vsgraphs.run.settings import apply_assignments

Interval = tuple[int, int]


@dataclass
class FrameTime:
    """Of one call, on the clock of the trace."""

    began_us: float
    wall_ms: float
    wait_ms: float

    def overlaps(self, intervals: list[Interval]) -> bool:
        """With any of them."""
        ended_us = self.began_us + 1e3 * self.wall_ms
        return any(begin < ended_us and self.began_us < end for begin, end in intervals)


def one_run(
    sequence: RecordedSequence, fps: float, settings: list[str]
) -> tuple[list[FrameTime], list[Interval], int]:
    """Frames but the first, the adjustments of the whole map (us), and how many loops were closed."""
    config = vsgraphs.Config()
    config.set("system.execution", "threaded")
    config.set("system.realtime", True)
    apply_assignments(config, settings)
    slam = vsgraphs.Slam(config, sequence.camera)
    times = []
    due = time.monotonic()
    for frame in sequence.frames:
        rgb, depth = frame.load()
        time.sleep(max(0.0, due - time.monotonic()))
        due = max(due, time.monotonic() - 1 / fps) + 1 / fps
        began, computed = time.monotonic_ns(), time.thread_time_ns()
        slam.track(rgb, depth, frame.timestamp)
        wall, cpu = time.monotonic_ns() - began, time.thread_time_ns() - computed
        times.append(FrameTime(began / 1e3, wall / 1e6, max(0, wall - cpu) / 1e6))
    slam.finish()
    adjustments = [
        (begin, begin + duration) for _, name, begin, duration, _ in slam.trace() if name == "full_adjustment"
    ]
    return times[1:], adjustments, slam.statistics()["loops"]


def row(name: str, times: list[FrameTime]) -> str:
    """Of the table."""
    if not times:
        return f"| {name} | 0 | - | - | - | - | - | - |"
    wall, wait = np.array([t.wall_ms for t in times]), np.array([t.wait_ms for t in times])
    cells = [f"{f(x):.2f}" for x in (wall, wait) for f in (np.median, lambda x: np.percentile(x, 95), np.max)]
    return f"| {name} | {len(times)} | " + " | ".join(cells) + " |"


def main() -> None:
    """Prints a Markdown table, and how much longer the frames during adjustments took."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("sequence", type=Path)
    parser.add_argument("--runs", type=int, default=1)
    parser.add_argument("--fps", type=float, help="default: the camera's")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="an option")
    options = parser.parse_args()
    sequence = vsgraphs.open_sequence(options.sequence)
    during: list[FrameTime] = []
    otherwise: list[FrameTime] = []
    for number in range(options.runs):
        times, adjustments, loops = one_run(sequence, options.fps or sequence.camera.fps, options.set)
        for frame in times:
            (during if frame.overlaps(adjustments) else otherwise).append(frame)
        spans = ", ".join(f"{(end - begin) / 1e3:.0f}" for begin, end in adjustments) or "none"
        print(f"run {number + 1}: {loops} loops, adjustments of {spans} ms", flush=True)
    print("\n| frames | number | median ms | p95 | max | wait: median ms | p95 | max |")
    print("|---|---|---|---|---|---|---|---|")
    print(row("during an adjustment", during))
    print(row("otherwise", otherwise))
    if during and otherwise:
        longer = [
            np.percentile([t.wall_ms for t in during], q) - np.percentile([t.wall_ms for t in otherwise], q)
            for q in (50, 95, 100)
        ]
        print("\nlonger by, ms: median {:.2f}, p95 {:.2f}, max {:.2f}".format(*longer))


if __name__ == "__main__":
    main()
