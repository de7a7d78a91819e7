"""Walls as strips on the plan: where a face was seen, how thick it is, where openings cut it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from vsgraphs.export.floorplan.view import PlanView
from vsgraphs.scene_graph import DoorNode, PlaneNode
from vsgraphs.trajectory import Array

UNKNOWN_THICKNESS_M = 0.1
_CUT_M = 1.9  # a wall seen only higher up is what stands over an opening or a cupboard
_SKIP_M = 0.05  # skirting boards' edges and the ground's own noise
_BRIDGE_M = 0.3
_SHORT_M = 0.2
_CORNER_M = 0.4


@dataclass(frozen=True, eq=False)
class Strip:
    """A stretch of one wall's face: points foot + t * along, t from begin to end, metres on the plan.

    inward: (2,) into the room; the wall's body lies on the other side, and reaches past the face's ends by
    before and after where it makes a corner with another. solid: seen below 1.9 m.
    """

    plane: int
    foot: Array
    along: Array
    inward: Array
    begin: float
    end: float
    thickness_m: float
    two_sided: bool
    solid: bool
    before: float = 0.0
    after: float = 0.0

    def face(self) -> Array:
        """(2, 2): its ends."""
        return np.array([self.foot + t * self.along for t in (self.begin, self.end)])

    def corners(self) -> Array:
        """(4, 2) of the body: along the face, then back along the other side."""
        a, b = (self.foot + t * self.along for t in (self.begin - self.before, self.end + self.after))
        back = self.thickness_m * self.inward
        return np.array([a, b, b - back, a - back])


def strips_of(plane: PlaneNode, view: PlanView, floor_m: float, top_m: float) -> list[Strip]:
    """The stretches of a wall between two heights along up."""
    cells = plane.extent.cells()
    heights = view.height(plane.extent.cell_centres()) - floor_m
    inside = (heights > _SKIP_M) & (heights < top_m - floor_m)
    cells, heights = cells[inside], heights[inside]
    if not len(cells):
        return []
    size = plane.extent.cell_m
    middle = plane.extent.lift(np.array([[0.0, (cells[:, 1].mean() + 0.5) * size]]))
    strip = Strip(
        plane=plane.id,
        foot=view.flat(middle)[0],
        along=view.direction(plane.extent.axis_u),
        inward=view.direction(plane.normal),
        begin=0.0,
        end=0.0,
        thickness_m=plane.thickness_m or UNKNOWN_THICKNESS_M,
        two_sided=plane.thickness_m is not None,
        solid=True,
    )
    low = _intervals(np.unique(cells[heights < _CUT_M, 0]), size)
    everywhere = _intervals(np.unique(cells[:, 0]), size)
    high = [piece for whole in everywhere for piece in _without(whole, low)]
    strips = [replace(strip, begin=a, end=b) for a, b in low if b - a > _SHORT_M]
    return strips + [replace(strip, begin=a, end=b, solid=False) for a, b in high if b - a > _SHORT_M]


def cut_doors(strips: Sequence[Strip], doors: Sequence[DoorNode], view: PlanView) -> list[Strip]:
    """The strips without what lies in the doors' openings."""
    out = list(strips)
    for door in doors:
        center, through = view.flat(door.center[None])[0], view.direction(door.normal)
        out = [piece for strip in out for piece in _cut(strip, center, through, door.width_m / 2)]
    return out


def join_corners(strips: Sequence[Strip]) -> list[Strip]:
    """Ends that nearly meet another wall's face are brought to it; the body past it, where that makes a
    corner.
    """
    return [_joined(strip, strips) for strip in strips]


def _intervals(bins: npt.NDArray[np.int64], size: float) -> list[tuple[float, float]]:
    """Ascending bins -> stretches [begin, end) in metres; short gaps are bridged."""
    if not len(bins):
        return []
    breaks = np.flatnonzero(np.diff(bins) > 1 + round(_BRIDGE_M / size))
    first = np.concatenate([[0], breaks + 1])
    last = np.concatenate([breaks, [len(bins) - 1]])
    return [(float(bins[i]) * size, float(bins[j] + 1) * size) for i, j in zip(first, last, strict=True)]


def _without(whole: tuple[float, float], holes: list[tuple[float, float]]) -> list[tuple[float, float]]:
    pieces = [whole]
    for low, high in holes:
        pieces = [
            part
            for a, b in pieces
            for part in ((a, min(b, low)), (max(a, high), b))
            if part[1] - part[0] > 1e-9
        ]
    return pieces


def _cut(strip: Strip, center: Array, through: Array, half_m: float) -> list[Strip]:
    away = center - strip.foot
    beside = abs(float(away @ strip.inward)) > max(0.35, strip.thickness_m + 0.1)
    if beside or abs(float(through @ strip.inward)) < 0.9:
        return [strip]
    at = float(away @ strip.along)
    pieces = _without((strip.begin, strip.end), [(at - half_m, at + half_m)])
    return [
        replace(
            strip,
            begin=a,
            end=b,
            before=strip.before if a == strip.begin else 0.0,
            after=strip.after if b == strip.end else 0.0,
        )
        for a, b in pieces
        if b - a > 0.03
    ]


def _joined(strip: Strip, others: Sequence[Strip]) -> Strip:
    ends = {"begin": strip.begin, "end": strip.end}
    bodies = {"begin": 0.0, "end": 0.0}
    best = dict.fromkeys(ends, _CORNER_M)
    for other in others:
        slope = float(other.inward @ strip.along)
        if other.plane == strip.plane or abs(slope) < 0.5:
            continue
        at = float(other.inward @ (other.foot - strip.foot)) / slope
        there = float((strip.foot + at * strip.along - other.foot) @ other.along)
        if not other.begin - _CORNER_M < there < other.end + _CORNER_M:
            continue
        for name, here, beyond in (("begin", strip.begin, slope > 0), ("end", strip.end, slope < 0)):
            if abs(at - here) < best[name]:
                best[name], ends[name] = abs(at - here), at
                bodies[name] = other.thickness_m / abs(slope) if beyond else 0.0
    if ends["end"] <= ends["begin"]:
        return strip
    begin, end = ends["begin"], ends["end"]
    return replace(strip, begin=begin, end=end, before=bodies["begin"], after=bodies["end"])
