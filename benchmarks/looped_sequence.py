#!/usr/bin/env python3
"""Do time and memory grow as the same way is walked again? Walks a sequence to and fro; prints each round.

    benchmarks/looped_sequence.py DATA/kitchen --rounds 5

A round is the sequence forwards, then backwards, so that the camera never jumps. Serial execution: a frame
without keyframe is tracking alone, one with a keyframe all of mapping too (medians of the round, and how many
keyframes were made); the round is all of its frames. CPU time of the calling thread; memory is what the
process holds at the end of the round; ATE is that of all frames so far, where the truth is known. The last
line is the last round's share of the first one's.
"""

from __future__ import annotations

import argparse
import os
import statistics
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from relocalisation import aligned, rmse_mm, true_positions

import vsgraphs
from vsgraphs.run.settings import apply_assignments
from vsgraphs.trajectory import read_tum_trajectory


def resident_mb() -> float:
    """Memory this process holds; Linux."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


@dataclass
class Round:
    """What a walk to and fro took, and what the map held after it."""

    plain_ms: list[float] = field(default_factory=list)
    keyframe_ms: list[float] = field(default_factory=list)
    keyframes: int = 0
    landmarks: int = 0
    planes: int = 0
    memory_mb: float = 0.0
    ate_mm: float | None = None

    def total_s(self) -> float:
        """All frames."""
        return (sum(self.plain_ms) + sum(self.keyframe_ms)) / 1e3

    def row(self, number: int) -> str:
        """Of the table."""
        plain, keyframe = (
            f"{statistics.median(times):.1f}" if times else "-" for times in (self.plain_ms, self.keyframe_ms)
        )
        return (
            f"| {number} | {self.total_s():.2f} | {plain} | {keyframe} | {len(self.keyframe_ms)} "
            f"| {self.keyframes} | {self.landmarks} | {self.planes} | {self.memory_mb:.0f} "
            f"| {'-' if self.ate_mm is None else format(self.ate_mm, '.1f')} |"
        )


HEADER = (
    "| round | round, s | without keyframe, ms | with keyframe, ms | made | keyframes | landmarks | planes "
    "| memory, MB | ATE, mm |\n|---|---|---|---|---|---|---|---|---|---|"
)


class Walker:
    """A camera that goes on and on."""

    def __init__(self, sequence: Any, config: vsgraphs.Config, truth: Any) -> None:
        self.slam = vsgraphs.Slam(config, sequence.camera)
        self.step_s = 1.0 / sequence.camera.fps
        self.truth = truth
        self.recorded: list[float] = []  # when each frame was

    def walk(self, frames: list[Any]) -> Round:
        """One frame after the other."""
        done = Round()
        for frame in frames:
            rgb, depth = frame.load()
            stamp = len(self.recorded) * self.step_s
            self.recorded.append(frame.timestamp)
            began = time.thread_time()
            result = self.slam.track(rgb, depth, stamp)
            spent_ms = 1e3 * (time.thread_time() - began)
            (done.keyframe_ms if result.is_keyframe else done.plain_ms).append(spent_ms)
        snapshot = self.slam.snapshot()
        done.keyframes, done.landmarks = len(snapshot.keyframes()[0]), len(snapshot.landmarks()[0])
        done.planes = len(snapshot.scene_graph()["planes"])
        done.memory_mb = resident_mb()
        done.ate_mm = self.ate_mm()
        return done

    def ate_mm(self) -> float | None:
        """RMSE of all positions so far, aligned with the truth."""
        if self.truth is None:
            return None
        stamps, poses = self.slam.trajectory()
        recorded = np.array(self.recorded)[np.round(stamps / self.step_s).astype(int)]
        within, true = true_positions(self.truth, recorded)
        positions = poses[within, :3, 3]
        return rmse_mm(positions, true, aligned(positions, true))


def main() -> None:
    """Prints a Markdown table, one row a round."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("sequence", type=Path)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--max-frames", type=int, help="use the first so many frames")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="an option")
    options = parser.parse_args()

    sequence = vsgraphs.open_sequence(options.sequence)
    frames = sequence.frames[: options.max_frames]
    config = vsgraphs.Config()
    config.set("system.execution", "serial")
    apply_assignments(config, options.set)
    file = options.sequence / "groundtruth.txt"
    walker = Walker(sequence, config, read_tum_trajectory(file) if file.exists() else None)
    print(HEADER)
    rounds: list[Round] = []
    for number in range(1, options.rounds + 1):
        rounds.append(walker.walk(frames + frames[::-1]))
        print(rounds[-1].row(number), flush=True)
    first, last = rounds[0], rounds[-1]
    print(f"\ntime {last.total_s() / first.total_s():.2f}, memory {last.memory_mb / first.memory_mb:.2f}")


if __name__ == "__main__":
    main()
