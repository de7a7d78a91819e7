"""`vsgraphs simulate`: a plan becomes a recorded sequence with exact truth."""

from __future__ import annotations

import shutil
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from vsgraphs.cli.interrupt import Interrupt
from vsgraphs.cli.progress import Progress
from vsgraphs.errors import InputError
from vsgraphs.export.atomic import write_atomically
from vsgraphs.export.lock import Locks
from vsgraphs.plans import plan_text
from vsgraphs.run.session import Tally
from vsgraphs.simulate import Output, simulate
from vsgraphs.simulate.camera import parse_effects
from vsgraphs.simulate.folder import part_of


@dataclass(frozen=True)
class Looks:
    """The camera, as the command's options name it. seed: of the noise; effects: KEY=VALUE."""

    seed: int
    noise: str
    sensor: str | None
    effects: list[str]


def out_folder(out: Path | None) -> Path:
    """Raises InputError if there is none."""
    if out is None:
        raise InputError("--out DIR is missing: the folder for the sequence (or --plan-only FILE)")
    return out


def make_sequence(
    plan: str | Mapping[str, Any],
    out: Path,
    *,
    looks: Looks,
    frames: int | None,
    output: Output,
) -> int:
    """Renders, shows how far it is, says what was written; returns the exit code. Raises InputError.

    plan: name or file, or a generated one: that is written as plan.json beside the frames.
    """
    began = time.monotonic()
    bar = _Bar()
    with (
        Locks(lambda line: print(f"warning: {line}", file=sys.stderr)) as locks,
        Interrupt(lambda: "interrupted: nothing was kept", partial(_discard, out)) as interrupt,
    ):
        hold(locks, out)
        done = simulate(
            plan,
            out,
            seed=looks.seed,
            noise=looks.noise,
            sensor=looks.sensor,
            effects=parse_effects(looks.effects),
            frames=frames,
            progress=bar.show,
            should_stop=interrupt.requested,
            output=output,
        )
    bar.clear()
    if not done.frames:
        print("interrupted before the first frame: nothing was written", file=sys.stderr)
        return interrupt.exit_code
    if isinstance(plan, Mapping):
        write_atomically(out / "plan.json", plan_text(plan))
    if not done.complete:
        print("interrupted: the frames so far are kept", file=sys.stderr)
    took = time.monotonic() - began
    print(
        f"{done.frames} frames, {done.path_length_m:.2f} m of path in {done.folder} "
        f"({took:.1f} s, {done.frames / took:.1f} frames/s)"
    )
    return interrupt.exit_code


def hold(locks: Locks, out: Path) -> None:
    """Keeps a second program from making the same folder. Raises InputError."""
    try:
        out.absolute().parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot create {out}: {error.strerror or error}") from None
    locks.hold_file(out)


def _discard(out: Path) -> None:
    """For a process that ends before the frames so far have become a sequence."""
    shutil.rmtree(part_of(out), ignore_errors=True)


class _Bar:
    """Progress of the rendering; the total is known from the first frame on."""

    def __init__(self) -> None:
        self._progress: Progress | None = None

    def show(self, written: int, total: int) -> None:
        """After each frame."""
        self._progress = self._progress or Progress(total)
        self._progress.frame(Tally(seen=written), "rendering")

    def clear(self) -> None:
        """Takes the bar away."""
        if self._progress:
            self._progress.clear()
