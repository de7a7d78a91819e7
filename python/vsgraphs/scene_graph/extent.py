"""How far a plane has been seen: outline, and the 0.1 m cells that hold observed points.

The outline is the convex hull (monotone chain; Andrew, "Another efficient algorithm for convex hulls in two
dimensions", IPL 1979). The hull bridges doorways and the corners of an L; area and extents along a wall are
taken from the cells, which do not.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vsgraphs.trajectory import Array

CELL_M = 0.1
_DIRECTIONS = 16  # in which the outermost points are sought
_ON_THE_EDGE_M2 = 5e-7  # half of what a square millimetre's coordinates can differ by


@dataclass(eq=False)
class PlaneExtent:
    """Observed extent in the plane's own axes.

    origin: (3,) the plane's point nearest the frame's origin. axis_u, axis_v: (3,) unit vectors in the plane,
    u x v = normal; of a wall u is horizontal and v points up. polygon: (N, 3) hull on the plane,
    counter-clockwise seen from the side that saw it. runs: (R, 3) int rows v, first u, last u of occupied
    cells; cell (u, v) covers [u, u + 1) x [v, v + 1) times cell_m from the origin.
    """

    origin: Array
    axis_u: Array
    axis_v: Array
    polygon: Array
    runs: npt.NDArray[np.int64]
    cell_m: float = CELL_M

    @property
    def area_m2(self) -> float:
        """Area of the occupied cells."""
        return float(np.sum(self.runs[:, 2] - self.runs[:, 1] + 1)) * self.cell_m**2

    def cells(self) -> npt.NDArray[np.int64]:
        """(C, 2) occupied cells u, v, row by row."""
        v, first, last = self.runs.T
        lengths = last - first + 1
        before = np.cumsum(lengths) - lengths  # cells of earlier runs
        u = np.arange(lengths.sum()) + np.repeat(first - before, lengths)
        return np.stack([u, np.repeat(v, lengths)], axis=1)

    def cell_centres(self) -> Array:
        """(C, 3) middles of the occupied cells, on the plane."""
        middles = (self.cells().astype(np.float64) + 0.5) * self.cell_m
        return self.lift(middles)

    def lift(self, uv: Array) -> Array:
        """(N, 2) plane coordinates in metres -> (N, 3)."""
        lifted: Array = self.origin + uv[:, :1] * self.axis_u + uv[:, 1:] * self.axis_v
        return lifted

    def flat(self, points: Array) -> Array:
        """(N, 3) -> (N, 2) coordinates of their projection on the plane, metres."""
        flat: Array = (points - self.origin) @ np.stack([self.axis_u, self.axis_v], axis=1)
        return flat


def extent_of(points: Array, normal: Array, offset_m: float, up: Array | None) -> PlaneExtent:
    """Extent of a plane from (N, 3) observed points, in any order. Cost N log N.

    Slits and holes up to two cells wide are closed: points are thinned before they come here.
    """
    axis_u, axis_v = plane_axes(normal, up)
    extent = PlaneExtent(-offset_m * normal, axis_u, axis_v, np.zeros((0, 3)), np.zeros((0, 3), np.int64))
    if len(points):
        uv = extent.flat(points)
        extent.polygon = extent.lift(convex_hull(uv))
        extent.runs = _runs(np.floor(uv / CELL_M).astype(np.int64))
    return extent


def plane_axes(normal: Array, up: Array | None) -> tuple[Array, Array]:
    """Unit vectors u, v in the plane with u x v = normal: v as far up as it goes, or, for planes that lie
    flatter than 45 degrees, u along the frame's x.
    """
    toward = up if up is not None else np.array([0.0, -1.0, 0.0])  # cameras look with y down
    if abs(float(normal @ toward)) < np.sqrt(0.5):
        v: Array = toward - normal * float(normal @ toward)
        v /= np.linalg.norm(v)
        across: Array = np.cross(v, normal)
        return across, v
    u: Array = np.array([1.0, 0.0, 0.0]) - normal * normal[0]
    u /= np.linalg.norm(u)
    along: Array = np.cross(normal, u)
    return u, along


def convex_hull(uv: Array) -> Array:
    """(N, 2) -> (H, 2) corners of the convex hull, counter-clockwise from the least, to a millimetre; points
    on edges go.
    """
    points = np.unique(_near_the_rim(np.round(uv, 3)), axis=0)  # in order of u, then v
    first = np.concatenate([[True], np.diff(points[:, 0]) > 0])
    ends: Array = points[first | np.roll(first, -1)]  # between the lowest and highest of a u no corner lies
    if len(ends) < 3:
        return ends
    corners = [(float(u), float(v)) for u, v in ends]
    return np.array(_half_hull(corners)[:-1] + _half_hull(corners[::-1])[:-1])


def _near_the_rim(points: Array) -> Array:
    """The points without those that lie inside the polygon of the outermost ones in some directions, and so
    are no corners of the hull (Akl and Toussaint, "A fast convex hull algorithm", IPL 1978): most of them.
    """
    angles = np.arange(_DIRECTIONS) * (2 * np.pi / _DIRECTIONS)
    outermost = np.argmax(np.stack([np.cos(angles), np.sin(angles)], axis=1) @ points.T, axis=1)
    corners = points[outermost]
    along = (
        np.roll(corners, -1, axis=0) - corners
    )  # counter-clockwise, of no length where one is outermost twice
    keep = np.zeros(len(points), dtype=bool)
    for (u0, v0), (du, dv) in zip(corners, along, strict=True):
        if du or dv:
            keep |= du * (points[:, 1] - v0) - dv * (points[:, 0] - u0) < _ON_THE_EDGE_M2
    rim: Array = points[keep | ~np.any(along)]
    return rim


def _half_hull(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    chain: list[tuple[float, float]] = []
    for u, v in points:
        while len(chain) > 1:
            (u0, v0), (u1, v1) = chain[-2:]
            if (u1 - u0) * (v - v0) - (v1 - v0) * (u - u0) > 1e-9:
                break
            chain.pop()
        chain.append((u, v))
    return chain


def _runs(cells: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Occupied cells, in any order and many times -> runs, after closing (dilating, then eroding by one)."""
    least = cells.min(axis=0) - 2
    grid = np.zeros(cells.max(axis=0) - least + 3, dtype=bool)
    grid[tuple((cells - least).T)] = True
    grid = ~_dilated(~_dilated(grid))
    grid[tuple((cells - least).T)] = True  # what the border of the grid ate
    runs = []
    for row in range(grid.shape[1]):
        edges = np.flatnonzero(np.diff(np.concatenate([[False], grid[:, row], [False]]).astype(np.int8)))
        runs += [
            (row + least[1], first + least[0], last + least[0] - 1)
            for first, last in zip(edges[::2], edges[1::2], strict=True)
        ]
    return np.array(runs, dtype=np.int64).reshape(-1, 3)


def _dilated(grid: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """The cells of the grid and their eight neighbours."""
    along = grid.copy()
    along[1:] |= grid[:-1]
    along[:-1] |= grid[1:]
    out = along.copy()
    out[:, 1:] |= along[:, :-1]
    out[:, :-1] |= along[:, 1:]
    return out
