"""What goes wrong between camera and disk: frames that get lost, come twice or stand still, clocks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields

from vsgraphs.errors import InputError
from vsgraphs.plans import Draw
from vsgraphs.reading import shown

TIMESTAMP_OFFSET_S = 1_700_000_000.0
_MOST_S = 3600.0


@dataclass(frozen=True)
class Stream:
    """Shares of frames: 0 to 1; times in seconds. 0 switches off."""

    drop_share: float = 0.0  # frames that are missing
    double_share: float = 0.0  # frames that show the images of the one before
    freeze_every_s: float = 0.0  # so often both images stand still ...
    freeze_s: float = 0.0  # ... for so long, while stamps go on
    stamp_jitter_s: float = 0.0  # spread of stamps about the true time, for colour and depth each
    clock_jump_at_s: float = 0.0  # from then on ...
    clock_jump_s: float = 0.0  # ... all clocks are so much ahead (negative: behind)

    def check(self) -> None:
        """Raises InputError naming the first value out of range."""
        for item in fields(self):
            value = getattr(self, item.name)
            low = -_MOST_S if item.name == "clock_jump_s" else 0.0
            high = 0.95 if item.name.endswith("share") else _MOST_S
            if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
                raise InputError(f"{item.name} must lie in {low:g}..{high:g}, not {shown(value)}")


@dataclass(frozen=True)
class Shot:
    """A frame of the sequence: which moment it should show, which it does, and the stamps it bears."""

    index: int
    source: int
    truth_stamp: str
    rgb_stamp: str
    depth_stamp: str


def schedule(indices: Sequence[int], fps: float, stream: Stream, seed: int) -> list[Shot]:
    """The frames that are written for the frames `indices` of a walk, in order of time."""
    draw = Draw(seed, "stream")
    shots: list[Shot] = []
    used: tuple[set[str], set[str]] = (set(), set())  # of colour and depth
    for index in indices:
        dropped, doubled = draw.chance(stream.drop_share), draw.chance(stream.double_share)
        errors = [_normal(draw) * stream.stamp_jitter_s for _ in range(2)]
        if dropped and shots:
            continue
        source = index
        if shots and (doubled or _frozen(index / fps, stream)):
            source = shots[-1].source
        now = index / fps
        if stream.clock_jump_s and now >= stream.clock_jump_at_s:
            now += stream.clock_jump_s
        stamps = [_free(now + error, taken) for error, taken in zip(errors, used, strict=True)]
        shots.append(Shot(index, source, _stamp(now), *stamps))
    return shots


def _frozen(time_s: float, stream: Stream) -> bool:
    if not stream.freeze_every_s or not stream.freeze_s or time_s < stream.freeze_every_s:
        return False
    return time_s % stream.freeze_every_s < stream.freeze_s


def _stamp(time_s: float) -> str:
    return f"{TIMESTAMP_OFFSET_S + time_s:.6f}"


def _free(time_s: float, used: set[str]) -> str:
    """A stamp of its own for every file of a kind: files are named by them."""
    stamp = _stamp(time_s)
    while stamp in used:
        time_s += 1e-6
        stamp = _stamp(time_s)
    used.add(stamp)
    return stamp


def _normal(draw: Draw) -> float:
    """Of unit spread, cut off at 2.5."""
    a, b = 1 - draw.share(), draw.share()
    return max(-2.5, min(2.5, math.sqrt(-2 * math.log(a)) * math.cos(2 * math.pi * b)))
