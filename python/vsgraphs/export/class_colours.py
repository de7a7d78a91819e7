"""Map points coloured by the class of the plane they lie on."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vsgraphs.scene_graph import CLASS_COLOURS, NO_PLANE, SceneGraph
from vsgraphs.trajectory import Array

ON_PLANE_M = 0.06
_REACH_CELLS = 2  # beyond the observed cells: between two of them that were thinned away, or at the rim


def plane_of_points(
    graph: SceneGraph, positions: Array, on_plane_m: float = ON_PLANE_M
) -> npt.NDArray[np.int64]:
    """(M, 3) points in the graph's frame -> (M,) id of the plane each lies on, -1 for none.

    A point lies on a plane at most on_plane_m away, over or within 0.2 m of its observed cells; of several on
    the nearest.
    """
    owner = np.full(len(positions), -1, dtype=np.int64)
    nearest = np.full(len(positions), on_plane_m)
    for plane in graph.planes.values():
        distance = np.abs(positions @ plane.normal + plane.offset_m)
        close = np.flatnonzero(distance < nearest)
        cells = plane.extent.cells()
        if not len(close) or not len(cells):
            continue
        least = cells.min(axis=0) - _REACH_CELLS
        grid = np.zeros(cells.max(axis=0) - least + _REACH_CELLS + 1, dtype=bool)
        for du in range(-_REACH_CELLS, _REACH_CELLS + 1):
            for dv in range(-_REACH_CELLS, _REACH_CELLS + 1):
                grid[tuple((cells - least + (du, dv)).T)] = True
        at = np.floor(plane.extent.flat(positions[close]) / plane.extent.cell_m).astype(np.int64) - least
        within = ((at >= 0) & (at < grid.shape)).all(axis=1)
        within[within] = grid[tuple(at[within].T)]
        owner[close[within]] = plane.id
        nearest[close[within]] = distance[close[within]]
    return owner


def class_colours(graph: SceneGraph, positions: Array) -> npt.NDArray[np.uint8]:
    """(M, 3) RGB of each point's class, for `format_ply`; grey where it lies on no plane."""
    colours = np.full((len(positions), 3), NO_PLANE, dtype=np.uint8)
    owner = plane_of_points(graph, positions)
    for plane in graph.planes.values():
        colours[owner == plane.id] = CLASS_COLOURS[plane.role]
    return colours
