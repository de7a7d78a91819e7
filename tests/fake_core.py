"""A stand-in for the compiled module: what is above it is tested without it. Its poses slide along x."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np


class InputError(ValueError):
    """As the compiled module's."""


@dataclass
class Result:
    status: str
    is_keyframe: bool = False
    index: int = 0

    @property
    def tracked(self) -> bool:
        return self.status not in ("lost", "waiting")


class Slam:
    """Tracks what it is given; `script` says the status of each frame, "ok" where it ends. Every fifth frame
    is a keyframe.
    """

    def __init__(self, script: list[str] | None = None) -> None:
        self.script = script or []
        self.stamps: list[float] = []
        self.seen = 0
        self.accepted = 0  # frames that were not refused: what the core counts
        self.first = 0  # the number it begins to count at, behind those of a loaded atlas
        self.finished = self.stopped = False
        self.segmentations: list[tuple[int, np.ndarray, np.ndarray | None, np.ndarray | None]] = []
        self.classes: list[tuple[np.ndarray | None, Sequence[str] | None]] = []  # of each of them

    def track(self, rgb: np.ndarray, depth: np.ndarray, timestamp: float) -> Result:
        if depth.dtype != np.uint16:
            raise InputError("depth: must be uint16 (raw units) or float32 (metres)")
        status = self.script[self.seen] if self.seen < len(self.script) else "ok"
        self.seen += 1
        if status == "refused":
            raise InputError("rgb: must be larger")
        result = Result(status, is_keyframe=self.accepted % 5 == 0, index=self.first + self.accepted)
        self.accepted += 1
        if result.tracked:
            self.stamps.append(timestamp)
        return result

    def add_segmentation(
        self,
        frame_index: int,
        roles: np.ndarray,
        confidence: np.ndarray | None,
        instances: np.ndarray | None,
        classes: np.ndarray | None = None,
        class_names: Sequence[str] | None = None,
    ) -> None:
        if self.finished:
            raise InputError("add_segmentation() after finish()")
        self.segmentations.append((frame_index, roles, confidence, instances))
        self.classes.append((classes, class_names))

    def stop(self) -> None:
        self.stopped = True

    def finish(self) -> None:
        self.finished = True

    def trajectory(self) -> tuple[np.ndarray, np.ndarray]:
        poses = np.tile(np.eye(4), (len(self.stamps), 1, 1))
        poses[:, 0, 3] = np.arange(len(self.stamps)) * 0.01
        return np.array(self.stamps), poses

    def snapshot(self) -> Slam:
        return self

    def keyframes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        stamps, poses = self.trajectory()
        return np.arange(len(stamps[::5]), dtype=np.uint32), stamps[::5], poses[::5]

    def landmarks(self) -> tuple[np.ndarray, np.ndarray]:
        return np.arange(12.0).reshape(4, 3), np.arange(12, dtype=np.uint8).reshape(4, 3)

    def statistics(self) -> dict[str, Any]:
        figures = dict.fromkeys(("median_ms", "p95_ms", "max_ms", "cpu_median_ms", "cpu_p95_ms"), 1.0)
        return {
            "waited_s": 0.5,
            "maps": 1,
            "loops": 2,
            "merges": 0,
            "loop_candidates": {"verdicts": {}, "nearest_refused": []},
            "join_candidates": {"verdicts": {}, "nearest_refused": []},
            "warnings": ["from the core"],
            "stages": {"track": {"count": self.seen, **figures}},
        }

    def trace(self) -> list[tuple[str, str, int, int, int]]:
        return [("tracking", "track", 1000 + 10 * i, 8, i) for i in range(self.seen)]


class Config:
    """Four options."""

    def __init__(self) -> None:
        self.values: dict[str, Any] = {
            "system.seed": 0,
            "system.mode": "slam",  # what it has: no planes
            "system.realtime": False,
            "system.execution": "threaded",
            "system.replay": "",
            "tracker.max_features": 1000,
            "tracker.huber_px": 2.5,
            "mapper.enabled": True,
        }

    def keys(self) -> list[str]:
        return list(self.values)

    def get(self, key: str) -> Any:
        return self.values[key]

    def set(self, key: str, value: Any) -> None:
        if type(value) is not type(self.values[key]):
            raise InputError(f"{key}: expected {type(self.values[key]).__name__}, not {value!r}")
        if isinstance(value, float | int) and not isinstance(value, bool) and not 0 <= value <= 1e6:
            raise InputError(f"{key}: {value} is out of range, 0 to 1000000")
        if isinstance(value, float) and math.isnan(value):
            raise InputError(f"{key}: not a number")
        self.values[key] = value
