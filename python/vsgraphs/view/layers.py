"""The scene graph as layers above the map: keyframes, walls, rooms, floors, and what holds them together.

After the pictures of Hughes et al., "Hydra" (RSS 2022), and of vS-Graphs.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from vsgraphs.scene_graph import CLASS_COLOURS, KINDS, Kind, SceneGraph, node_key, transform_points
from vsgraphs.trajectory import Array
from vsgraphs.view.surfaces import room_colour

Rgb = tuple[int, int, int]
FLOOR_COLOUR: Rgb = (240, 240, 240)
MAX_LINKED_KEYFRAMES = 40  # the links of more would be a carpet
_LEVELS = {"keyframe": 1, "plane": 2, "room": 3, "floor": 4}  # what is drawn as a box stands beside planes
_SHOWN_EDGES = ("observes_plane", "bounds", "belongs_to", "door", "lies_in")


@dataclass
class Layer:
    """Nodes of one kind, of a section. places (N, 3) m, colours (N, 3), names for people, "" for none."""

    section: str
    places: Array
    colours: npt.NDArray[np.uint8]
    names: list[str]


@dataclass
class LayeredGraph:
    """layers: by kind of node. edges: kind -> (E, 2, 3) ends; edge_colours: kind -> (E, 3).

    stilts: (S, 2, 3) from rooms down to the ground they stand for.
    size_m: what to make radii and gaps of: a fraction of the map's extent.
    """

    size_m: float
    layers: dict[str, Layer] = field(default_factory=dict)
    edges: dict[str, Array] = field(default_factory=dict)
    edge_colours: dict[str, npt.NDArray[np.uint8]] = field(default_factory=dict)
    stilts: Array = field(default_factory=lambda: np.zeros((0, 2, 3)))


def layered_graph(graph: SceneGraph, up_from_graph: Array) -> LayeredGraph:
    """Every node at its place on the plan, at its layer's height. Linear in nodes and edges."""
    low, high = bounds(graph, up_from_graph)
    reach = float(np.linalg.norm(high[:2] - low[:2]))
    out = LayeredGraph(size_m=min(max(0.01 * reach, 0.04), 0.3))
    gap = min(max(0.09 * reach, 0.5), 3.0)
    places: dict[str, Array] = {}
    colours: dict[str, Rgb] = {}
    for kind in KINDS:
        level = _LEVELS.get(kind.name, _LEVELS["plane"] if kind.boxed else 0)
        if not level:
            continue
        listed = _shown(kind, graph)
        at = transform_points(up_from_graph, np.array([place for _, place, *_ in listed]).reshape(-1, 3))
        at[:, 2] = high[2] + gap * level
        shades = np.array([colour for *_, colour, _ in listed], np.uint8).reshape(-1, 3)
        out.layers[kind.name] = Layer(kind.section, at, shades, [name for *_, name in listed])
        places |= {node_key(kind.name, number): at[i] for i, (number, *_) in enumerate(listed)}
        colours |= {node_key(kind.name, number): colour for number, _, colour, _ in listed}
    _add_edges(out, graph, places, colours)
    rooms = list(graph.rooms.values())
    if rooms:
        feet = transform_points(up_from_graph, np.array([room.centroid for room in rooms]))
        feet[:, 2] = [transform_points(up_from_graph, room.polygon)[:, 2].mean() for room in rooms]
        out.stilts = np.stack([feet, out.layers["room"].places], axis=1)
    return out


def _shown(kind: Kind[Any], graph: SceneGraph) -> list[tuple[int, Array, Rgb, str]]:
    """Id, place, colour and name of the kind's nodes; of planes the walls."""
    nodes = list(graph.section(kind.section).values())
    if kind.name == "plane":
        nodes = graph.planes_of("wall")
    colours: dict[str, Callable[[Any], Rgb]] = {
        "room": lambda room: room_colour(room.id),
        "floor": lambda _: FLOOR_COLOUR,
    }
    names: dict[str, Callable[[Any], str]] = {
        "room": lambda room: str(room.name),
        "floor": lambda floor: f"floor {floor.id}",
    }
    colour, name = colours.get(kind.name, kind.rgb), names.get(kind.name, lambda _: "")
    return [(node.id, kind.place(node), colour(node), name(node)) for node in nodes]


def _add_edges(
    out: LayeredGraph, graph: SceneGraph, places: dict[str, Array], colours: dict[str, Rgb]
) -> None:
    step = 1 + len(graph.keyframes) // MAX_LINKED_KEYFRAMES
    drawn = {node_key("keyframe", k) for k in list(graph.keyframes)[::step]}
    for kind in _SHOWN_EDGES:
        ends, shades = [], []
        for edge in graph.edges:
            known = edge.source in places and edge.target in places
            if edge.kind == kind and known and (kind != "observes_plane" or edge.source in drawn):
                ends.append((places[edge.source], places[edge.target]))
                shades.append(CLASS_COLOURS["door"] if kind == "door" else colours[edge.target])
        out.edges[kind] = np.array(ends).reshape(-1, 2, 3)
        out.edge_colours[kind] = np.array(shades, np.uint8).reshape(-1, 3)


def wall_heading(graph: SceneGraph, up_from_graph: Array) -> float:
    """Angle of the walls' common direction against x, radians in [-pi/4, pi/4).

    The mean by area; walls a right angle apart count as one direction.
    """
    total = 0j
    for plane in graph.planes_of("wall"):
        normal = up_from_graph[:3, :3] @ plane.normal
        total += plane.area_m2 * np.exp(4j * np.arctan2(normal[1], normal[0]))
    return float(np.angle(total)) / 4 if total else 0.0


def bounds(graph: SceneGraph, up_from_graph: Array) -> tuple[Array, Array]:
    """(3,) least and (3,) greatest coordinates of walls, grounds, rooms and keyframes.

    A metre around the start where there are none.
    """
    shown = [plane.extent.polygon for plane in graph.planes.values() if plane.role in ("wall", "ground")]
    cameras = [keyframe.world_from_camera[None, :3, 3] for keyframe in graph.keyframes.values()]
    rooms = [room.polygon for room in graph.rooms.values()]
    parts = [part for part in shown + cameras + rooms if len(part)]
    if not parts:
        return np.full(3, -1.0), np.full(3, 1.0)
    points = transform_points(up_from_graph, np.concatenate(parts))
    return points.min(axis=0), points.max(axis=0)
