"""The sequences of an ablation: recordings in a folder, and simulated plans rendered on demand."""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass
from pathlib import Path

from run_sequences import call

# Lists fixed beforehand, so that no list is chosen for its result.
LISTS = {
    "building_components": (
        "one_room",
        "l_shape",
        "trapezoid",
        "hexagon",
        "two_rooms",
        "three_rooms",
        "corridor",
        "rendered_room",
        "sevenscenes_redkitchen",
    ),
}

# ATE RMSE in metres, lowest and highest, of ORB-SLAM3 (Campos et al., T-RO 2021; RGB-D, 1,000 features),
# measured by others on a quiet 2-core machine, medians of 2 to 4 runs: docs/benchmarks.md, "Recorded
# sequences". Of rendered_room one run in four gave 1.22 besides.
ORB_SLAM3_ATE_M = {
    "sevenscenes_redkitchen": (0.048, 0.048),
    "tum_fr1_xyz_first230": (0.0106, 0.0106),
    "rendered_room": (0.18, 0.21),
}

RECORDED_DRAW = 0  # a recording has one draw of its noise


@dataclass(frozen=True)
class Sequences:
    """Where sequences are found: recordings in data (None: there are none), simulations below cache."""

    program: list[str]
    data: Path | None
    cache: Path
    every: int = 1

    def recorded(self, name: str) -> Path | None:
        """A recording's folder: a path, or a name in the data folder; None for a plan's name."""
        if self.data is not None and (self.data / name).is_dir():
            return self.data / name
        return Path(name) if "/" in name and Path(name).is_dir() else None

    def draws(self, name: str, wanted: list[int]) -> list[int]:
        """The draws of noise that a sequence has."""
        return wanted if self.recorded(name) is None else [RECORDED_DRAW]

    def simulated(self, name: str, draw: int) -> Path:
        """Where a simulation lies in the cache, rendered or not."""
        thinned = "" if self.every == 1 else f"_every{self.every}"
        return self.cache / f"{Path(name).stem}_{draw}{thinned}"

    def folder(self, name: str, draw: int) -> Path:
        """The sequence's folder; renders what the cache has not. Raises RuntimeError."""
        recorded = self.recorded(name)
        if recorded is not None:
            return recorded
        folder = self.simulated(name, draw)
        if not folder.exists():
            print(f"rendering {folder}", file=sys.stderr, flush=True)
            self.cache.mkdir(parents=True, exist_ok=True)
            options = ["--seed", str(draw), "--every", str(self.every), "--labels-every", "0"]
            call([*self.program, "simulate", name, "--out", str(folder), *options])
        _check_cached(folder, name, draw)
        return folder


def _check_cached(folder: Path, plan: str, draw: int) -> None:
    truth = folder / "scene_gt.json"
    if not truth.is_file():
        raise RuntimeError(f"{folder} has no scene_gt.json: remove it to have it rendered")
    found = json.loads(truth.read_text())
    same_plan = found.get("plan") == plan or plan.endswith(".json")  # a file's plan is named inside it
    if not same_plan or found.get("noise_seed") != draw:
        what = f"plan {found.get('plan')} draw {found.get('noise_seed')}"
        raise RuntimeError(f"{folder} holds {what}: remove it to have {plan}, draw {draw}, rendered")
