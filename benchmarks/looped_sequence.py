#!/usr/bin/env python3
"""Do time and memory grow as the same way is walked again? Walks a sequence to and fro; prints each round.

    benchmarks/looped_sequence.py DATA/kitchen --rounds 5

A round is the sequence forwards, then backwards, so that the camera never jumps. Serial execution: a frame
without keyframe is tracking alone, one with a keyframe all of mapping too. CPU time of the calling thread;
memory is what the process holds at the end of the round.
"""

from __future__ import annotations

import argparse
import os
import statistics
import time
from pathlib import Path

import vsgraphs


def resident_mb() -> float:
    """Memory this process holds; Linux."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def main() -> None:
    """Prints a Markdown table, one row a round."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("sequence", type=Path)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--max-frames", type=int, help="use the first so many frames")
    options = parser.parse_args()

    sequence = vsgraphs.open_sequence(options.sequence)
    frames = sequence.frames[: options.max_frames]
    config = vsgraphs.Config()
    config.set("system.execution", "serial")
    slam = vsgraphs.Slam(config, sequence.camera)
    stamp = 0.0
    print(
        "| round | frames | without keyframe, ms | with keyframe, ms | keyframes | landmarks | planes "
        "| memory, MB |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for number in range(1, options.rounds + 1):
        plain: list[float] = []
        with_keyframe: list[float] = []
        for frame in frames + frames[::-1]:
            rgb, depth = frame.load()
            stamp += 1.0 / sequence.camera.fps
            began = time.thread_time()
            result = slam.track(rgb, depth, stamp)
            spent_ms = 1e3 * (time.thread_time() - began)
            (with_keyframe if result.is_keyframe else plain).append(spent_ms)
        snapshot = slam.snapshot()
        medians = [f"{statistics.median(times):.1f}" if times else "-" for times in (plain, with_keyframe)]
        counts = (len(snapshot.keyframes()[0]), len(snapshot.landmarks()[0]))
        planes = len(snapshot.scene_graph()["planes"])
        print(
            f"| {number} | {2 * len(frames)} | {medians[0]} | {medians[1]} | {counts[0]} | {counts[1]} "
            f"| {planes} | {resident_mb():.0f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
