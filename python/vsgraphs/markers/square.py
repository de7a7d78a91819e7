"""A printed square before a camera: where its corners and its paper show, and the pose that fits both best.

A pose is camera_from_marker, (4, 4). Moves of it are (m, rad), on its right: in the marker's own frame.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from vsgraphs.lens import distort
from vsgraphs.trajectory import Array

Metres = np.ndarray[Any, np.dtype[np.float32]]

CORNER_SIGMA_PX = 0.5
# Where depth is read, as a share of the side: the edges may show the wall behind.
_GRID = np.linspace(-0.4, 0.4, 5)
_LEAST_READINGS = 8
_INDEPENDENT = 4  # as many independent readings as those of a square are worth: neighbours err alike
_OUTLIER_SIGMAS = 5.0


def corners_of(size_m: float) -> Array:
    """(4, 3) in the marker's frame (x right, y up, z out of the paper), in the order OpenCV reads them."""
    half = size_m / 2
    return np.array(
        [[-half, half, 0], [half, half, 0], [half, -half, 0], [-half, -half, 0]], dtype=np.float64
    )


@dataclass(frozen=True)
class DepthReadings:
    """Depth of the paper: rays (N, 3) with z = 1, metres (N,) along z.

    What is wrong with one of them is that pixel's noise; what all have in common is also the offset between
    the depth and the colour image, or the size the print was said to have.
    """

    rays: Array
    metres: Array
    sigma_m: float
    common_sigma_m: float

    @classmethod
    def at(cls, pose: Array, size_m: float, metres: Metres, camera: Any) -> DepthReadings | None:
        """Where `pose` puts the print in a depth image (h, w), NaN without reading; None with too few."""
        x, y = np.meshgrid(_GRID * size_m, _GRID * size_m)
        points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)]) @ pose[:3, :3].T + pose[:3, 3]
        if points[:, 2].min() <= 0:
            return None
        rays = points / points[:, 2:]
        u, v = (np.rint(axis).astype(np.int64) for axis in distort(camera, rays[:, 0], rays[:, 1]))
        height, width = metres.shape
        inside = np.flatnonzero((u >= 0) & (v >= 0) & (u < width) & (v < height))
        seen = metres[v[inside], u[inside]].astype(np.float64)
        good = np.isfinite(seen)
        if good.sum() < _LEAST_READINGS:
            return None
        offset, scale, onset = camera.depth_noise
        sigma = float(offset + scale * (points[:, 2].mean() - onset) ** 2)
        common = float(np.hypot(sigma / np.sqrt(_INDEPENDENT), camera.depth_alignment_m))
        return cls(rays[inside[good]], seen[good], sigma, common)

    def off(self, pose: Array) -> Array:
        """(N,) m: by how much they lie behind the paper."""
        normal = pose[:3, 2]
        return np.asarray(self.metres - (normal @ pose[:3, 3]) / (self.rays @ normal), dtype=np.float64)

    def tilt_misfit(self, pose: Array) -> float:
        """chi^2 of what they have not in common."""
        off = self.off(pose)
        return _INDEPENDENT * float(np.mean(np.minimum(((off - np.median(off)) / self.sigma_m) ** 2, 25.0)))

    def scale(self, pose: Array) -> float:
        """Measured over predicted depth."""
        return float(np.median(self.metres / (self.metres - self.off(pose))))

    def consistent(self, pose: Array) -> DepthReadings | None:
        """Those in line with the others; None with too few."""
        off = self.off(pose)
        good = np.abs(off - np.median(off)) < _OUTLIER_SIGMAS * self.sigma_m
        if good.sum() < _LEAST_READINGS:
            return None
        return DepthReadings(self.rays[good], self.metres[good], self.sigma_m, self.common_sigma_m)

    def rows(self, pose: Array) -> tuple[Array, Array]:
        """Whitened: residuals (N + 1,) and their derivatives (N + 1, 6) by moves of the pose."""
        rotation, shift = pose[:3, :3], pose[:3, 3]
        slant = self.rays @ rotation[:, 2]
        off = self.off(pose)
        to_middle = (shift - (self.metres - off)[:, None] * self.rays) / slant[:, None]
        by_turn = -(to_middle @ rotation) @ cross_matrix(np.array([0.0, 0.0, 1.0]))
        depth_by_move = np.column_stack([np.zeros((len(slant), 2)), 1 / slant, by_turn])
        each = np.sqrt(_INDEPENDENT / len(off)) / self.sigma_m
        residuals = np.append((off - off.mean()) * each, off.mean() / self.common_sigma_m)
        middle = depth_by_move.mean(axis=0)
        jacobian = -np.vstack([(depth_by_move - middle) * each, middle / self.common_sigma_m])
        return residuals, jacobian


def shown_ideally(pose: Array, size_m: float, camera: Any) -> Array:
    """(4, 2) pixels of the corners without the lens."""
    points = corners_of(size_m) @ pose[:3, :3].T + pose[:3, 3]
    focal, middle = np.array([camera.fx, camera.fy]), np.array([camera.cx, camera.cy])
    return np.asarray(points[:, :2] / points[:, 2:] * focal + middle, dtype=np.float64)


def pixel_misfit(pose: Array, corners: Array, size_m: float, camera: Any) -> float:
    """chi^2 of ideal corners (4, 2); infinite for a square that is not wholly before the camera."""
    if (corners_of(size_m) @ pose[2, :3] + pose[2, 3]).min() <= 0:
        return float("inf")
    return float(np.sum((shown_ideally(pose, size_m, camera) - corners) ** 2)) / CORNER_SIGMA_PX**2


def refine(
    pose: Array, corners: Array, size_m: float, camera: Any, readings: DepthReadings | None = None
) -> Array:
    """The pose near `pose` that fits ideal corners (4, 2), and readings, best: damped Gauss-Newton."""

    def misfit(at: Array) -> float:
        pixels = pixel_misfit(at, corners, size_m, camera)
        if readings is None or not np.isfinite(pixels):
            return pixels
        return pixels + float(np.sum(readings.rows(at)[0] ** 2))

    best, damping = misfit(pose), 1e-6
    for _ in range(20):
        residuals, jacobian = _rows(pose, corners, size_m, camera, readings)
        information = jacobian.T @ jacobian
        damped = information + damping * np.diag(np.diag(information))
        moved = _moved(pose, -np.asarray(np.linalg.solve(damped, jacobian.T @ residuals), dtype=np.float64))
        after = misfit(moved)
        if after < best:
            settled = best - after < 1e-9 * best
            pose, best, damping = moved, after, damping / 10
            if settled:
                break
        else:
            damping *= 10
            if damping > 1e3:
                break
    return pose


def covariance_of(
    pose: Array,
    size_m: float,
    camera: Any,
    sigma_px: float = CORNER_SIGMA_PX,
    readings: DepthReadings | None = None,
) -> Array:
    """(6, 6): what corners off by `sigma_px` each way, and readings, leave open."""
    jacobian = _corner_jacobian(pose, size_m, camera)
    information = jacobian.T @ jacobian / sigma_px**2
    if readings is not None:
        by_depth = readings.rows(pose)[1]
        information = information + by_depth.T @ by_depth
    covariance = np.linalg.inv(information)
    return np.asarray((covariance + covariance.T) / 2, dtype=np.float64)


def _rows(
    pose: Array, corners: Array, size_m: float, camera: Any, readings: DepthReadings | None
) -> tuple[Array, Array]:
    residuals = (shown_ideally(pose, size_m, camera) - corners).ravel() / CORNER_SIGMA_PX
    jacobian = _corner_jacobian(pose, size_m, camera) / CORNER_SIGMA_PX
    if readings is None:
        return residuals, jacobian
    off, by_move = readings.rows(pose)
    return np.append(residuals, off), np.vstack([jacobian, by_move])


def _corner_jacobian(pose: Array, size_m: float, camera: Any) -> Array:
    """(8, 6): corners in the image by moves of the pose."""
    jacobian = np.zeros((8, 6))
    for i, corner in enumerate(corners_of(size_m)):
        x, y, z = pose[:3, :3] @ corner + pose[:3, 3]
        by_point = np.array(
            [[camera.fx / z, 0, -camera.fx * x / z**2], [0, camera.fy / z, -camera.fy * y / z**2]]
        )
        by_move = np.hstack([np.eye(3), -cross_matrix(corner)])
        jacobian[2 * i : 2 * i + 2] = by_point @ pose[:3, :3] @ by_move
    return jacobian


def _moved(pose: Array, move: Array) -> Array:
    shift, turn = move[:3], move[3:]
    angle = float(np.linalg.norm(turn))
    axis = cross_matrix(turn / angle) if angle > 0 else np.zeros((3, 3))
    rotation = np.eye(3) + np.sin(angle) * axis + (1 - np.cos(angle)) * axis @ axis
    moved = pose.copy()
    moved[:3, :3] = pose[:3, :3] @ rotation
    moved[:3, 3] = pose[:3, 3] + pose[:3, :3] @ shift
    return moved


def cross_matrix(v: Array) -> Array:
    """(3, 3): times w it gives v x w."""
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
