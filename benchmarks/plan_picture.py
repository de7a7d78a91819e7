#!/usr/bin/env python3
"""Draws plans from above: rooms, doors, windows, furniture, pictures on the walls, and the camera's way.

    benchmarks/plan_picture.py picture.png line-24-4 ring-16-4
    benchmarks/plan_picture.py picture.png mine.json two_floors

A plan is a file, an included plan's name, or a generated building as KIND-ROOMS-FURNISHINGS[-SEED]. Storeys
are drawn below one another. Rooms with the same furniture have the same colour. Prints a Markdown table of
the plans' sizes: way-points joined by straight lines, frames at the plan's rate.
"""

from __future__ import annotations

import argparse
import json
import math
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
from building_places import building_arguments
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from vsgraphs.compiled import core
from vsgraphs.plans import building, load_plan

Plan = dict[str, Any]


def plan_of(name: str) -> Plan:
    """A plan as nested dicts. Raises ValueError, OSError."""
    included = resources.files("vsgraphs.plans") / f"{name}.json"
    file = Path(name) if name.endswith(".json") else included
    if file is not included or included.is_file():
        found: Plan = json.loads(file.read_text())
        return found
    words = building_arguments(name)
    kind, *numbers = words[1::2]
    return building(kind, *map(int, numbers))


def looks(plan: Plan, room: str) -> str:
    """What a room looks like inside: equal texts, equal rooms."""
    things = [box for box in plan.get("boxes", []) if box["room"] == room]
    return json.dumps(sorted([box.get("kind", "box"), box.get("seed", 0)] for box in things))


def draw_level(axes: Axes, plan: Plan, level: int, colours: dict[str, Any]) -> None:
    """One storey."""
    rooms = {room["id"]: room for room in plan["rooms"] if room.get("level", 0) == level}
    for name, room in rooms.items():
        colour = colours[looks(plan, name)]
        axes.add_patch(Polygon(room["polygon"], facecolor=colour, edgecolor="black", linewidth=0.6))
        middle = np.mean(room["polygon"], axis=0)
        axes.annotate(name, middle, ha="center", va="center", fontsize=5, color="0.35", zorder=5)
    for thing, colour, width in (("windows", "deepskyblue", 2.0), ("posters", "crimson", 1.6)):
        for item in plan.get(thing, []):
            if item["room"] in rooms:
                _on_wall(axes, rooms[item["room"]], item, colour, width)
    for box in plan.get("boxes", []):
        if box["room"] in rooms:
            axes.add_patch(Polygon(footprint(box), facecolor="tan", edgecolor="saddlebrown", linewidth=0.4))
    for stairs in plan.get("stairs", []):
        if stairs["room"] in rooms:
            axes.annotate("", stairs["to"], stairs["from"], arrowprops={"arrowstyle": "->", "color": "0.3"})
    for door in plan.get("doors", []):
        here = [rooms[room] for room in door["rooms"] if room in rooms]
        if here:
            ends = opening(door, here[0])
            axes.plot(ends[:, 0], ends[:, 1], color="white", linewidth=2.6, solid_capstyle="butt", zorder=3)


def footprint(box: dict[str, Any]) -> np.ndarray:
    """Corners of a box on the floor, (4, 2), metres."""
    yaw = math.radians(box.get("yaw_deg", 0))
    turn = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])
    half = np.array(box["size"][:2]) / 2
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * half
    found: np.ndarray = corners @ turn.T + np.array(box["at"])
    return found


def opening(door: dict[str, Any], room: dict[str, Any]) -> np.ndarray:
    """Both sides of a door's opening, (2, 2), metres: along the wall of the room that is nearest."""
    corners, at = np.array(room["polygon"], dtype=float), np.array(door["at"])
    edges = np.roll(corners, -1, axis=0) - corners
    lengths = np.linalg.norm(edges, axis=1)[:, None]
    along = edges / lengths
    on_edge = np.clip(((at - corners) * along).sum(axis=1)[:, None], 0, lengths)
    nearest = int(np.linalg.norm(corners + on_edge * along - at, axis=1).argmin())
    half = door.get("width", 0.95) / 2 * along[nearest]
    return np.array([at - half, at + half])


def _on_wall(axes: Axes, room: dict[str, Any], item: dict[str, Any], colour: str, width: float) -> None:
    corners = np.array(room["polygon"], dtype=float)
    a, b = corners[item["wall"]], corners[(item["wall"] + 1) % len(corners)]
    along = (b - a) / np.linalg.norm(b - a)
    half = item.get("width", 0.6) / 2
    ends = np.array([a + (item["along"] + side * half) * along for side in (-1, 1)])
    axes.plot(ends[:, 0], ends[:, 1], color=colour, linewidth=width, solid_capstyle="butt")


def draw_way(axes: Axes, plan: Plan, level: int) -> None:
    """The way-points of one storey; those that name no room belong to all."""
    levels = {room["id"]: room.get("level", 0) for room in plan["rooms"]}
    points = plan["path"]["waypoints"]
    here = [i for i, point in enumerate(points) if levels.get(point.get("room", ""), level) == level]
    stretch: list[int] = []
    for i in [*here, len(points) + 1]:
        if stretch and i != stretch[-1] + 1:
            at = np.array([points[j]["at"] for j in stretch])
            axes.plot(at[:, 0], at[:, 1], color="seagreen", linewidth=0.7, zorder=4)
            stretch = []
        stretch.append(i)


def draw(names: list[str]) -> Figure:
    """A row for each plan and storey."""
    plans = [plan_of(name) for name in names]
    panels = [(p, n, level) for p, n in zip(plans, names, strict=True) for level in _levels(p)]
    sizes = [_size(plan) for plan, _, _ in panels]
    width = max(x for x, _ in sizes)
    scale = min(0.35, 11 / width)  # inches per metre
    heights = [y * scale + 0.3 for _, y in sizes]
    figure = Figure(figsize=(width * scale + 0.3, sum(heights)), layout="constrained")
    grid = figure.subplots(len(panels), 1, height_ratios=heights, squeeze=False)[:, 0]
    for axes, (plan, name, level) in zip(grid, panels, strict=True):
        kinds = list(dict.fromkeys(looks(plan, room["id"]) for room in plan["rooms"]))
        pastel = [(0.99, 0.97, 0.93), *_pastels(len(kinds))]
        colours = {kind: pastel[0] if kind == "[]" else pastel[i + 1] for i, kind in enumerate(kinds)}
        draw_level(axes, plan, level, colours)
        draw_way(axes, plan, level)
        axes.set_title(name if len(_levels(plan)) == 1 else f"{name}, storey {level}", fontsize=7, loc="left")
        axes.set_aspect("equal")
        axes.autoscale_view()
        axes.axis("off")
    return figure


def _levels(plan: Plan) -> list[int]:
    return sorted({room.get("level", 0) for room in plan["rooms"]})


def _size(plan: Plan) -> tuple[float, float]:
    corners = np.array([corner for room in plan["rooms"] for corner in room["polygon"]])
    x, y = corners.max(axis=0) - corners.min(axis=0)
    return float(x), float(y)


def _pastels(count: int) -> list[tuple[float, float, float]]:
    from matplotlib.colors import hsv_to_rgb

    rows = [hsv_to_rgb((i / max(count, 1), 0.22, 0.97)) for i in range(count)]
    return [(float(r), float(g), float(b)) for r, g, b in rows]


def sizes_table(names: list[str]) -> str:
    """How much there is to see and to walk."""
    lines = ["| plan | rooms | doors | way, m | frames |", "|---|---:|---:|---:|---:|"]
    for name in names:
        plan = plan_of(name)
        scene = core().build_scene(load_plan(plan).plan)
        at = np.array([point["at"] for point in plan["path"]["waypoints"]])
        at = np.array([*at, *(at[:1] if plan["path"].get("closed") else [])])
        way = np.linalg.norm(np.diff(at, axis=0), axis=1).sum()
        counted = sum(room.get("counted", True) for room in plan["rooms"])
        lines.append(
            f"| {name} | {counted} | {len(plan.get('doors', []))} | {way:.0f} | {scene.frame_count} |"
        )
    return "\n".join(lines)


def main() -> None:
    """Writes the picture, prints the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("picture", type=Path, help="a .png")
    parser.add_argument("plans", nargs="+", metavar="PLAN", help="file, included plan, or building")
    parser.add_argument("--dpi", type=int, default=110)
    options = parser.parse_args()
    draw(options.plans).savefig(options.picture, dpi=options.dpi, metadata={"Software": None})
    print(sizes_table(options.plans))


if __name__ == "__main__":
    main()
