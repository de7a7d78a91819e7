"""What stands around the plan: frame, title, scale bar, axes, legend."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vsgraphs.export.floorplan.storeys import Storey
from vsgraphs.export.floorplan.style import (
    DOOR,
    INK,
    LINTEL,
    ONE_FACE,
    PAPER,
    PATH,
    SOFT_INK,
    WALL,
    hex_colour,
)
from vsgraphs.export.floorplan.svg import Page
from vsgraphs.export.floorplan.view import PlanView
from vsgraphs.scene_graph import KINDS, SceneGraph
from vsgraphs.scene_graph.kinds import count
from vsgraphs.trajectory import Array


def draw_frame(page: Page, width: float, height: float) -> None:
    """Paper and border."""
    page.rectangle(0, 0, width, height, fill=PAPER)
    page.rectangle(10, 10, width - 20, height - 20, fill="none", stroke="#c5cbd6", stroke_width=1.2)


def draw_title(page: Page, graph: SceneGraph, title: str, left: float) -> None:
    """Title, and a line of what the plan holds."""
    page.text(left, 42, title, font_size=20, font_weight="bold", fill=INK)
    facts = []
    if "rooms" in graph.estimated:
        area = sum(room.area_m2 for room in graph.rooms.values())
        facts.append(f"{_count(len(graph.rooms), 'room')}, {area:.1f} m²")
    facts.append(_count(len(graph.planes_of("wall")), "wall"))
    if "doors" in graph.estimated:
        facts.append(_count(len(graph.doors), "door"))
    boxed = [(kind, len(graph.section(kind.section))) for kind in KINDS if kind.boxed and kind.in_plan]
    facts += [count(number, kind.name, kind.section) for kind, number in boxed if number]
    if graph.frame.ground is None:  # heights are from something else than readers take for granted
        facts.append(f"z = 0: {graph.frame.zero_height}")
    page.text(left, 61, "  ·  ".join(facts), font_size=12, fill=SOFT_INK)


def draw_legend(
    page: Page, storeys: list[Storey], view: PlanView, scale: float, place: tuple[float, float, float]
) -> None:
    """Scale bar at the left, axes beside it, what the strokes mean at the right.

    place: left, top, right, px.
    """
    left, top, right = place
    _scale_bar(page, left, top, scale)
    _axes(page, view, left + 260, top + 8)
    entries = _entries(storeys)
    x = right - sum(width for _, width, _ in entries)
    for text, width, symbol in entries:
        symbol(page, x, top + 4)
        page.text(x + 30, top + 8, text, font_size=11, fill=SOFT_INK)
        x += width


def _scale_bar(page: Page, x: float, y: float, scale: float) -> None:
    length_m = next((m for m in (1, 2, 5, 10, 20, 50, 100) if m * scale >= 100), 200)
    half = length_m * scale / 2
    page.rectangle(x, y, half, 6, fill=INK, stroke=INK, stroke_width=1)
    page.rectangle(x + half, y, half, 6, fill=PAPER, stroke=INK, stroke_width=1)
    for at, text in ((0.0, "0"), (2 * half, f"{length_m} m")):
        page.text(x + at, y + 22, text, font_size=11, fill=SOFT_INK, text_anchor="middle")


def _axes(page: Page, view: PlanView, x: float, y: float) -> None:
    """Where the x and y of the other files point: the plan is turned to fit the page."""
    names = "xy" if abs(view.up[2]) > 0.5 else "xz"
    columns = (0, 1) if names == "xy" else (0, 2)
    for name, column in zip(names, columns, strict=True):
        tip = np.array([x, y]) + 18 * np.array([view.axes[0, column], -view.axes[1, column]])
        page.line(np.array([[x, y], tip]), stroke=SOFT_INK, stroke_width=1.3, stroke_linecap="round")
        out = np.array([x, y]) + 27 * np.array([view.axes[0, column], -view.axes[1, column]])
        page.text(out[0], out[1] + 3.5, name, font_size=11, fill=SOFT_INK, text_anchor="middle")
    page.circle(x, y, 1.8, fill=SOFT_INK)


_Symbol = Callable[[Page, float, float], None]


def _entries(storeys: list[Storey]) -> list[tuple[str, float, _Symbol]]:
    """Text, width in px and symbol of what occurs on the plan."""
    strips = [strip for storey in storeys for strip in storey.strips]
    kinds = {door.kind for storey in storeys for door in storey.doors}
    entries: list[tuple[str, float, _Symbol]] = []
    if any(strip.solid and strip.two_sided for strip in strips):
        entries.append(("wall", 74, _swatch(WALL, WALL)))
    if any(strip.solid and not strip.two_sided for strip in strips):
        entries.append(("one face seen", 128, _swatch(ONE_FACE, ONE_FACE, WALL)))
    if any(not strip.solid for strip in strips):
        entries.append(("seen only above 1.9 m", 172, _swatch(LINTEL, SOFT_INK)))
    if "door" in kinds:
        entries.append(("door", 76, _stroke(DOOR)))
    if "passage" in kinds:
        entries.append(("passage", 90, _stroke(DOOR, "4 3")))
    for kind in dict.fromkeys(kind for storey in storeys for kind, _ in storey.boxes):
        colour = hex_colour(kind.colour)
        entries.append((kind.name, 40 + 7 * len(kind.name), _swatch(colour, colour)))
    if any(storey.path for storey in storeys):
        entries.append(("camera path", 100, _stroke(PATH)))
    return entries


def _swatch(fill: str, stroke: str, face: str | None = None) -> _Symbol:
    def draw(page: Page, x: float, y: float) -> None:
        page.rectangle(x, y - 4, 22, 9, fill=fill, stroke=stroke, stroke_width=0.8)
        if face is not None:
            page.line(_segment(x, y + 5), stroke=face, stroke_width=2)

    return draw


def _stroke(colour: str, dashes: str = "none") -> _Symbol:
    def draw(page: Page, x: float, y: float) -> None:
        page.line(_segment(x, y), stroke=colour, stroke_width=2, stroke_dasharray=dashes)

    return draw


def _segment(x: float, y: float) -> Array:
    return np.array([[x, y], [x + 22, y]])


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"
