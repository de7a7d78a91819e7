"""The places of a run over buildings: plan files and generated buildings, simulated once into a folder."""

from __future__ import annotations

import hashlib
import json
import sys
import threading
from dataclasses import dataclass, field
from pathlib import Path

from run_sequences import call

BUILDING_KINDS = ("line", "ring", "star", "storeys")


@dataclass(frozen=True)
class Place:
    """A plan file that is to be walked. digest: of its text, so that a changed plan is simulated anew."""

    name: str
    plan: Path
    digest: str

    @staticmethod
    def of(plan: Path, name: str | None = None) -> Place:
        """Raises ValueError for a file that cannot be read or is no JSON object."""
        try:
            text = plan.read_bytes()
            whole = isinstance(json.loads(text), dict)
        except (OSError, ValueError) as error:
            raise ValueError(f"cannot read plan {plan}: {error}") from None
        if not whole:
            raise ValueError(f"{plan} is no plan: expected a JSON object")
        return Place(name or plan.stem, plan, hashlib.sha256(text).hexdigest()[:10])


def building_arguments(name: str) -> list[str]:
    """`vsgraphs simulate`'s for KIND-ROOMS-FURNISHINGS or KIND-ROOMS-FURNISHINGS-SEED. Raises ValueError."""
    kind, *numbers = name.split("-")
    if kind not in BUILDING_KINDS or len(numbers) not in (2, 3) or not all(n.isdecimal() for n in numbers):
        kinds = "|".join(BUILDING_KINDS)
        raise ValueError(f"'{name}' is no building: write {kinds}, rooms, furnishings[, seed], as line-24-4")
    rooms, furnishings, seed = (*numbers, "0")[:3]
    return ["--building", kind, "--rooms", rooms, "--furnishings", furnishings, "--seed", seed]


@dataclass(frozen=True)
class Places:
    """Where plans and sequences lie: below `folder`. every, frames: as `vsgraphs simulate` takes them."""

    program: list[str]
    folder: Path
    every: int = 1
    frames: int | None = None
    _busy: threading.Lock = field(default_factory=threading.Lock)
    _each: dict[Path, threading.Lock] = field(default_factory=dict)

    def building(self, name: str) -> Place:
        """The plan of a named building, written to the folder. Raises ValueError, RuntimeError."""
        words = building_arguments(name)
        plan = self.folder / "plans" / f"{name}.json"
        plan.parent.mkdir(parents=True, exist_ok=True)
        call([*self.program, "simulate", *words, "--plan-only", str(plan), "--overwrite"])
        return Place.of(plan, name)

    def sequence(self, place: Place, draw: int) -> Path:
        """The place's sequence with this draw of noise; simulated unless it is there. Raises RuntimeError."""
        shortened = "" if self.frames is None else f"-first{self.frames}"
        name = f"{place.name}-{place.digest}-draw{draw}-every{self.every}{shortened}"
        folder = self.folder / "sequences" / name
        with self._busy:
            lock = self._each.setdefault(folder, threading.Lock())
        with lock:  # two runs of one sequence do not simulate it twice
            if not (folder / "scene_gt.json").is_file():  # written last
                self._simulate(place, draw, folder)
        return folder

    def _simulate(self, place: Place, draw: int, folder: Path) -> None:
        print(f"simulating {folder}", file=sys.stderr, flush=True)
        partial = folder.with_name(f"{folder.name}.partial")  # Ctrl-C leaves a shorter, valid sequence
        words = ["--seed", str(draw), "--every", str(self.every), "--labels-every", "0", "--overwrite"]
        words += [] if self.frames is None else ["--frames", str(self.frames)]
        call([*self.program, "simulate", str(place.plan), "--out", str(partial), *words])
        partial.rename(folder)
