#!/usr/bin/env python3
"""How well does the place index recognise places? Asks it about keyframes of a saved atlas that came back.

    vsgraphs run DATA/three_rooms --out OUT --save-atlas OUT/atlas.vsg
    benchmarks/place_recall.py OUT/atlas.vsg DATA/three_rooms

A keyframe came back if the truth has it within --near-m and --near-deg of one older by --gap keyframes or
more. Its best candidate among those is right if it is that near, wrong if it is farther than --far-m or
turned by more than --far-deg, where the two hardly see the same; between the two it is neither. Recall@1 at
100 % precision: the share of the keyframes that came back whose best candidate is right and scores higher
than every wrong one of any keyframe. Of the index alone: geometry has not been asked yet.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import vsgraphs
from vsgraphs.trajectory import read_tum_trajectory


@dataclass
class Answer:
    """What the index said of one keyframe."""

    came_back: bool
    right: bool
    wrong: bool
    score: float  # 0 if it said nothing
    took_ms: float


class Truth:
    """Where keyframes really were."""

    def __init__(self, file: Path, stamps: np.ndarray) -> None:
        trajectory = read_tum_trajectory(file)
        at = np.abs(trajectory.timestamps[None, :] - stamps[:, None]).argmin(axis=1)
        self.poses = trajectory.poses[at]

    def near(self, a: int, others: np.ndarray, limit_m: float, limit_deg: float) -> np.ndarray:
        """Which of others (indices) are near a, bool."""
        away_m = np.linalg.norm(self.poses[others, :3, 3] - self.poses[a, :3, 3], axis=1)
        traces = np.einsum("nij,ij->n", self.poses[others, :3, :3], self.poses[a, :3, :3])
        turned = np.rad2deg(np.arccos(np.clip((traces - 1) / 2, -1, 1)))
        near: np.ndarray = (away_m < limit_m) & (turned < limit_deg)
        return near


def ask(atlas: Any, truth: Truth, ids: np.ndarray, options: argparse.Namespace) -> list[Answer]:
    """About every keyframe with others that are old enough."""
    answers = []
    for a, keyframe in enumerate(ids):
        older = np.flatnonzero(ids + options.gap <= keyframe)
        if not older.size:
            continue
        near, not_far = (
            set(ids[older[truth.near(a, older, *limits)]].tolist())
            for limits in ((options.near_m, options.near_deg), (options.far_m, options.far_deg))
        )
        began = time.thread_time()
        similar = atlas.similar_places(int(keyframe), gap=options.gap, count=1)
        took_ms = 1e3 * (time.thread_time() - began)
        best, score = similar[0] if similar else (-1, 0.0)
        wrong = bool(similar) and best not in not_far
        answers.append(Answer(bool(near), best in near, wrong, score, took_ms))
    return answers


def main() -> None:
    """Prints the figures."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("atlas", type=Path)
    parser.add_argument("sequence", type=Path, help="folder with groundtruth.txt")
    parser.add_argument("--gap", type=int, default=10)
    parser.add_argument("--near-m", type=float, default=1.0)
    parser.add_argument("--near-deg", type=float, default=30.0)
    parser.add_argument("--far-m", type=float, default=2.0)
    parser.add_argument("--far-deg", type=float, default=60.0)
    options = parser.parse_args()
    began = time.perf_counter()
    atlas = vsgraphs.load_atlas(options.atlas)
    loaded_s = time.perf_counter() - began
    ids, stamps, _ = atlas.snapshot().keyframes()
    ids = ids.astype(np.int64)
    megabytes = options.atlas.stat().st_size / 1e6
    print(f"{len(ids)} keyframes, {megabytes:.1f} MB, loaded in {loaded_s:.2f} s")
    answers = ask(atlas, Truth(options.sequence / "groundtruth.txt", stamps), ids, options)
    back = [a for a in answers if a.came_back]
    if not back:
        raise SystemExit("no keyframe came back")
    wrong = max((a.score for a in answers if a.wrong), default=0.0)
    first = sum(a.right for a in back)
    sure = sum(a.right and a.score > wrong for a in back)
    took = [a.took_ms for a in answers]
    print(f"came back: {len(back)} of {len(answers)}; best candidate right: {first / len(back):.2f}")
    print(f"recall@1 at 100 % precision: {sure / len(back):.2f}, above a score of {wrong:.4f}")
    print(f"a question: median {np.median(took):.1f} ms, slowest {max(took):.1f} ms CPU")


if __name__ == "__main__":
    main()
