"""Which of a square's two poses it is, and how exactly it is known.

A square seen from afar looks the same tilted to either side. Its corners in the image tell the two apart only
near by; a depth image does so as far away as its noise is smaller than the square's tilt.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from vsgraphs.trajectory import Array

Metres = np.ndarray[Any, np.dtype[np.float32]]

CORNER_SIGMA_PX = 0.5
SMALLEST_SIDE_PX = 12.0  # smaller ones are read wrongly too often, and their pose is worth little
_GRID = np.linspace(
    -0.4, 0.4, 5
)  # where depth is read, as a share of the side: the edges may show the wall behind
_LEAST_READINGS = 8
_DECISIVE = 9.0  # difference of chi^2: three sigmas
_SAME_RAD = np.deg2rad(15)  # two poses that differ by less are one, known by so much less
_SCALE_TOLERANCE = 0.15  # of depth to the size told


@dataclass(frozen=True)
class SquarePose:
    """camera_from_marker: (4, 4). covariance: (6, 6) of (m, rad), moves on the right of it. wrong_scale: by
    which factor depth says that the print is larger than told, where that is beyond tolerance; otherwise
    None.
    """

    camera_from_marker: Array
    covariance: Array
    wrong_scale: float | None = None


def corners_of(size_m: float) -> Array:
    """(4, 3) in the marker's frame (x right, y up, z out of the paper), in the order OpenCV reads them."""
    half = size_m / 2
    return np.array(
        [[-half, half, 0], [half, half, 0], [half, -half, 0], [-half, -half, 0]], dtype=np.float64
    )


def two_poses(corners: Array, size_m: float, camera: Any) -> list[Array]:
    """The poses (4, 4), one or two, at which a square with these ideal corners (4, 2) stands locally best.

    One from the homography (Zhang, "A flexible new technique for camera calibration", PAMI 2000), the other
    from its mirror image about the line of sight (Schweighofer and Pinz, "Robust pose estimation from a
    planar target", PAMI 2006), each refined. OpenCV's own (SOLVEPNP_IPPE_SQUARE) are turned wrongly in 5.0.0.
    """
    first = _by_homography(corners, size_m, camera)
    if first is None:
        return []
    first = refine(first, corners, size_m, camera)
    sight = first[:3, 3] / np.linalg.norm(first[:3, 3])
    mirrored = first.copy()
    mirrored[:3, :3] = (2 * np.outer(sight, sight) - np.eye(3)) @ first[:3, :3] @ np.diag([-1.0, -1.0, 1.0])
    second = refine(mirrored, corners, size_m, camera)
    return [first] if _angle_between(first, second) < 1e-3 else [first, second]


def _by_homography(corners: Array, size_m: float, camera: Any) -> Array | None:
    square = corners_of(size_m)[:, :2]
    rays = (corners - [camera.cx, camera.cy]) / [camera.fx, camera.fy]
    rows = []
    for (x, y), (u, v) in zip(square, rays, strict=True):
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y, -u], [0, 0, 0, x, y, 1, -v * x, -v * y, -v]]
    homography = np.linalg.svd(np.array(rows))[2][-1].reshape(3, 3)
    scale = (np.linalg.norm(homography[:, 0]) + np.linalg.norm(homography[:, 1])) / 2
    if not scale > 0 or homography[2, 2] == 0:
        return None
    homography = homography / (scale * np.sign(homography[2, 2]))  # the square lies before the camera
    axes = np.column_stack([homography[:, 0], homography[:, 1], np.cross(homography[:, 0], homography[:, 1])])
    left, _, right = np.linalg.svd(axes)
    pose: Array = np.eye(4)
    pose[:3, :3] = left @ np.diag([1, 1, np.linalg.det(left @ right)]) @ right
    pose[:3, 3] = homography[:, 2]
    return pose if np.isfinite(pose).all() and _pixel_misfit(pose, corners, size_m, camera) < np.inf else None


def decide(
    solutions: list[Array], corners: Array, size_m: float, metres: Metres, camera: Any
) -> SquarePose | None:
    """The right one of `solutions` (4, 4), or None where nothing tells them apart.

    corners: (4, 2) ideal pixels; metres: (h, w) depth along z, NaN where there is none.
    """
    facing = [pose for pose in solutions if pose[2, 3] > 0 and pose[:3, 2] @ pose[:3, 3] < 0]
    if not facing:
        return None
    depths = [_DepthFit.of(pose, size_m, metres, camera) for pose in facing]
    misfits = [
        _pixel_misfit(pose, corners, size_m, camera) + (0.0 if fit is None else fit.misfit)
        for pose, fit in zip(facing, depths, strict=True)
    ]
    best = int(np.argmin(misfits))
    pose, fit = facing[best], depths[best]
    covariance = covariance_of(pose, size_m, camera)
    for other, misfit in zip(facing, misfits, strict=True):
        angle = _angle_between(pose, other)
        if other is pose or misfit - misfits[best] >= _DECISIVE:
            continue
        if angle > _SAME_RAD:
            return None
        covariance[3:, 3:] += np.eye(3) * angle**2
    wrong = None if fit is None or abs(fit.scale - 1) <= _SCALE_TOLERANCE else fit.scale
    return SquarePose(pose, covariance, wrong)


def covariance_of(pose: Array, size_m: float, camera: Any, sigma_px: float = CORNER_SIGMA_PX) -> Array:
    """(6, 6): what corners off by `sigma_px` each way leave open, by the projection's Jacobian."""
    jacobian = _jacobian(pose, size_m, camera)
    covariance = sigma_px**2 * np.linalg.inv(jacobian.T @ jacobian)
    return np.asarray((covariance + covariance.T) / 2, dtype=np.float64)


def refine(pose: Array, corners: Array, size_m: float, camera: Any) -> Array:
    """The pose (4, 4) near `pose` whose corners are nearest to (4, 2) ideal pixels: damped Gauss-Newton."""
    best, damping = _pixel_misfit(pose, corners, size_m, camera), 1e-6
    for _ in range(20):
        jacobian = _jacobian(pose, size_m, camera)
        off = (corners - _shown_ideally(pose, size_m, camera)).ravel()
        information = jacobian.T @ jacobian
        damped = information + damping * np.diag(np.diag(information))
        moved = _moved(pose, np.asarray(np.linalg.solve(damped, jacobian.T @ off), dtype=np.float64))
        misfit = _pixel_misfit(moved, corners, size_m, camera)
        if misfit < best:
            settled = best - misfit < 1e-9 * best
            pose, best, damping = moved, misfit, damping / 10
            if settled:
                break
        else:
            damping *= 10
            if damping > 1e3:
                break
    return pose


def _jacobian(pose: Array, size_m: float, camera: Any) -> Array:
    """(8, 6): corners in the image by (shift, turn) of the marker in its own frame."""
    jacobian = np.zeros((8, 6))
    for i, corner in enumerate(corners_of(size_m)):
        x, y, z = pose[:3, :3] @ corner + pose[:3, 3]
        by_point = np.array(
            [[camera.fx / z, 0, -camera.fx * x / z**2], [0, camera.fy / z, -camera.fy * y / z**2]]
        )
        by_move = np.hstack([np.eye(3), -_cross_matrix(corner)])
        jacobian[2 * i : 2 * i + 2] = by_point @ pose[:3, :3] @ by_move
    return jacobian


def _moved(pose: Array, move: Array) -> Array:
    shift, turn = move[:3], move[3:]
    angle = float(np.linalg.norm(turn))
    axis = _cross_matrix(turn / angle) if angle > 0 else np.zeros((3, 3))
    rotation = np.eye(3) + np.sin(angle) * axis + (1 - np.cos(angle)) * axis @ axis
    moved = pose.copy()
    moved[:3, :3] = pose[:3, :3] @ rotation
    moved[:3, 3] = pose[:3, 3] + pose[:3, :3] @ shift
    return moved


@dataclass(frozen=True)
class _DepthFit:
    misfit: float  # chi^2 of the square's tilt
    scale: float  # measured over predicted depth

    @classmethod
    def of(cls, pose: Array, size_m: float, metres: Metres, camera: Any) -> _DepthFit | None:
        """Depth against where the pose puts the print; None with too few readings."""
        x, y = np.meshgrid(_GRID * size_m, _GRID * size_m)
        points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)]) @ pose[:3, :3].T + pose[:3, 3]
        if points[:, 2].min() <= 0:
            return None
        u, v = _shown_at(points, camera)
        height, width = metres.shape
        inside = (u >= 0) & (v >= 0) & (u < width) & (v < height)
        seen = metres[v[inside], u[inside]].astype(np.float64)
        predicted = points[inside, 2]
        good = np.isfinite(seen)
        if good.sum() < _LEAST_READINGS:
            return None
        seen, predicted = seen[good], predicted[good]
        offset, scale, onset = camera.depth_noise
        sigma = offset + scale * (predicted.mean() - onset) ** 2
        off = seen - predicted
        # What all readings have in common is the sensor's or the size's, not the tilt; neighbours are not
        # independent.
        tilt = off - np.median(off)
        misfit = 4 * float(np.mean(np.minimum((tilt / sigma) ** 2, 25.0)))
        return cls(misfit, float(np.median(seen / predicted)))


def _shown_at(points: Array, camera: Any) -> tuple[Any, Any]:
    """Pixels (rounded) at which the lens shows points (N, 3); Brown-Conrady."""
    x, y = points[:, 0] / points[:, 2], points[:, 1] / points[:, 2]
    k1, k2, p1, p2, k3 = camera.distortion
    r2 = x * x + y * y
    radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
    return (
        np.rint(camera.fx * u + camera.cx).astype(np.int64),
        np.rint(camera.fy * v + camera.cy).astype(np.int64),
    )


def _pixel_misfit(pose: Array, corners: Array, size_m: float, camera: Any) -> float:
    """chi^2; infinite for a square that is not wholly before the camera."""
    if (corners_of(size_m) @ pose[2, :3] + pose[2, 3]).min() <= 0:
        return float("inf")
    return float(np.sum((_shown_ideally(pose, size_m, camera) - corners) ** 2)) / CORNER_SIGMA_PX**2


def _shown_ideally(pose: Array, size_m: float, camera: Any) -> Array:
    points = corners_of(size_m) @ pose[:3, :3].T + pose[:3, 3]
    focal, middle = np.array([camera.fx, camera.fy]), np.array([camera.cx, camera.cy])
    return np.asarray(points[:, :2] / points[:, 2:] * focal + middle, dtype=np.float64)


def _angle_between(a: Array, b: Array) -> float:
    cosine = (np.trace(a[:3, :3].T @ b[:3, :3]) - 1) / 2
    return float(np.arccos(np.clip(cosine, -1, 1)))


def _cross_matrix(v: Array) -> Array:
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
