"""The map in a viewer: landmarks, planes with names, rooms on the ground, the layered graph above."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from vsgraphs.scene_graph import CLASS_COLOURS, KINDS, ROLES, SceneGraph, transform_points
from vsgraphs.trajectory import Array
from vsgraphs.view.extra import rerun
from vsgraphs.view.layers import LayeredGraph, layered_graph
from vsgraphs.view.sinks import Sinks
from vsgraphs.view.surfaces import (
    Mesh,
    box_outline,
    door_outline,
    name_place,
    plane_mesh,
    room_colour,
    room_mesh,
    room_place,
)

PATH_COLOUR = (235, 70, 60)
_PLANE_ALPHA = {"wall": 165, "ground": 190}
_EDGE_ALPHA = {"observes_plane": 60, "bounds": 200, "belongs_to": 230, "door": 255}
_AREA_ALPHA = {"whole": 255, "partial": 60}  # of what was seen in part the ground shows through
_LIFTED = np.array([0.0, 0.0, 0.06])  # above the room's area, which lies above the ground
_NAMED = ("wall", "ground", "door", "window")


def log_constants(sinks: Sinks) -> None:
    """What holds for the whole recording: z is up, and the colours of the classes."""
    rr = rerun()
    sinks.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    context = [(i, role, CLASS_COLOURS[role]) for i, role in enumerate(ROLES, 1)]
    sinks.log("/", rr.AnnotationContext([(0, "none", (0, 0, 0, 0)), *context]), static=True)


def log_landmarks(sinks: Sinks, points: Array, colours: npt.NDArray[np.uint8]) -> None:
    """(M, 3) z-up points and their (M, 3) colours."""
    rr = rerun()
    sinks.log("world/landmarks", rr.Points3D(points, colors=colours, radii=rr.Radius.ui_points(1.3)))


def log_path(sinks: Sinks, positions: Array) -> None:
    """(N, 3) z-up positions of the camera, in order of time."""
    rr = rerun()
    strips = [positions] if len(positions) > 1 else []
    sinks.log("world/path", rr.LineStrips3D(strips, colors=[PATH_COLOUR], radii=rr.Radius.ui_points(1.5)))


def log_scene(sinks: Sinks, graph: SceneGraph, up_from_graph: Array) -> None:
    """Everything the scene graph holds, replacing what was shown of it before."""
    sinks.renew("world/planes", [f"world/planes/{p.role}/{p.id}" for p in graph.planes.values()])
    _log_planes(sinks, graph, up_from_graph)
    _log_rooms(sinks, graph, up_from_graph)
    _log_boxes(sinks, graph, up_from_graph)
    _log_layers(sinks, layered_graph(graph, up_from_graph))


def _log_planes(sinks: Sinks, graph: SceneGraph, up_from_graph: Array) -> None:
    """Each plane under its own name, so that it can be picked and switched off."""
    rr = rerun()
    for plane in graph.planes.values():
        path = f"world/planes/{plane.role}/{plane.id}"
        _log_mesh(sinks, path, plane_mesh([plane], up_from_graph), _PLANE_ALPHA.get(plane.role, 90))
        if plane.role not in _NAMED or not len(plane.extent.polygon):
            continue
        outline = np.concatenate([plane.extent.polygon, plane.extent.polygon[:1]])
        sinks.log(
            f"{path}/outline",
            rr.LineStrips3D(
                [transform_points(up_from_graph, outline)],
                colors=[CLASS_COLOURS[plane.role]],
                radii=rr.Radius.ui_points(1.0 if plane.role != "ground" else 0.4),
            ),
        )
        place = name_place(plane, up_from_graph)
        _log_names(sinks, f"{path}/name", place[None], [f"{plane.role} {plane.id}"])


def _log_rooms(sinks: Sinks, graph: SceneGraph, up_from_graph: Array) -> None:
    rr = rerun()
    rooms = list(graph.rooms.values())
    for part, alpha in _AREA_ALPHA.items():
        shown = [room for room in rooms if room.partial == (part == "partial")]
        _log_mesh(sinks, f"world/rooms/areas/{part}", room_mesh(shown, up_from_graph), alpha)
    outlines = [
        transform_points(up_from_graph, np.concatenate([room.polygon, room.polygon[:1]])) + _LIFTED
        for room in rooms
    ]
    colours = [room_colour(room.id) for room in rooms]
    sinks.log(
        "world/rooms/outlines",
        rr.LineStrips3D(outlines, colors=colours or None, radii=rr.Radius.ui_points(2.5)),
    )
    places = [room_place(room, up_from_graph) for room in rooms]
    names = [f"{room.name}, {room.area_m2:.1f} m²{' (partial)' if room.partial else ''}" for room in rooms]
    _log_names(sinks, "world/rooms/names", np.array(places).reshape(-1, 3), names)
    doors = [door_outline(door, up_from_graph) for door in graph.doors.values()]
    sinks.log(
        "world/doors",
        rr.LineStrips3D(doors, colors=[CLASS_COLOURS["door"]], radii=rr.Radius.ui_points(2.5)),
    )


def _log_boxes(sinks: Sinks, graph: SceneGraph, up_from_graph: Array) -> None:
    """Each kind that is drawn as its box under its section's name."""
    rr = rerun()
    for kind in KINDS:
        if not kind.boxed:
            continue
        nodes = list(graph.section(kind.section).values())
        boxes = [(node, box) for node in nodes if (box := kind.box(node, graph)) is not None]
        outlines = [box_outline(box, up_from_graph) for _, box in boxes]
        path = f"world/{kind.section}"
        strips = rr.LineStrips3D(outlines, colors=[kind.colour], radii=rr.Radius.ui_points(2.0))
        sinks.log(path, strips)
        places = np.array([outline.max(axis=0) for outline in outlines]).reshape(-1, 3)
        _log_names(sinks, f"{path}/names", places, [kind.title(node, graph) for node, _ in boxes])


def _log_layers(sinks: Sinks, layered: LayeredGraph) -> None:
    rr = rerun()
    sizes = {"keyframe": 0.35, "plane": 0.9, "room": 1.6, "floor": 2.0}
    for kind, layer in layered.layers.items():
        sinks.log(
            f"world/graph/{layer.section}",
            rr.Points3D(layer.places, colors=layer.colours, radii=layered.size_m * sizes.get(kind, 0.9)),
        )
        if any(layer.names):
            above = layer.places + np.array([0.0, 0.0, 1.5 * layered.size_m * sizes.get(kind, 0.9)])
            _log_names(sinks, f"world/graph/{layer.section}/names", above, layer.names)
    for kind, ends in layered.edges.items():
        shades = np.full((len(ends), 4), _EDGE_ALPHA.get(kind, 200), np.uint8)
        shades[:, :3] = layered.edge_colours[kind]
        width = {"observes_plane": 0.4, "door": 3.0}.get(kind, 1.3)
        sinks.log(
            f"world/graph/edges/{kind}",
            rr.LineStrips3D(ends, colors=shades, radii=rr.Radius.ui_points(width)),
        )
    sinks.log(
        "world/graph/edges/stands_on",
        rr.LineStrips3D(layered.stilts, colors=[(200, 200, 200, 70)], radii=rr.Radius.ui_points(0.7)),
    )


def _log_mesh(sinks: Sinks, path: str, mesh: Mesh, alpha: int) -> None:
    rr = rerun()
    shown: Any = rr.Clear(recursive=False)
    if len(mesh.triangles):
        shown = rr.Mesh3D(
            vertex_positions=mesh.vertices,
            triangle_indices=mesh.triangles,
            vertex_colors=mesh.colours,
            albedo_factor=(255, 255, 255, alpha),
        )
    sinks.log(path, shown)


def _log_names(sinks: Sinks, path: str, places: Array, names: list[str]) -> None:
    rr = rerun()
    sinks.log(
        path,
        rr.Points3D(
            places, labels=names, colors=[(255, 255, 255)], radii=rr.Radius.ui_points(0.1), show_labels=True
        ),
    )
