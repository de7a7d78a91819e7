"""Which of a square's two poses it is, and how exactly it is known.

A square seen from afar looks the same tilted to either side. Its corners in the image tell the two apart only
near by; a depth image does so as far away as its noise is smaller than the square's tilt. Depth then says how
far away it is, too: half a pixel in the side of a small square is centimetres of distance.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from vsgraphs.markers.square import (
    DepthReadings,
    Metres,
    corners_of,
    covariance_of,
    pixel_misfit,
    refine,
)
from vsgraphs.trajectory import Array

SMALLEST_SIDE_PX = 12.0  # smaller ones are read wrongly too often, and their pose is worth little
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


def decide(
    solutions: list[Array], corners: Array, size_m: float, metres: Metres, camera: Any
) -> SquarePose | None:
    """The right one of `solutions` (4, 4), settled between corners and depth, or None where nothing tells
    them apart.

    corners: (4, 2) ideal pixels; metres: (h, w) depth along z, NaN where there is none.
    """
    facing = [pose for pose in solutions if pose[2, 3] > 0 and pose[:3, 2] @ pose[:3, 3] < 0]
    if not facing:
        return None
    depths = [DepthReadings.at(pose, size_m, metres, camera) for pose in facing]
    misfits = [
        pixel_misfit(pose, corners, size_m, camera)
        + (0.0 if readings is None else readings.tilt_misfit(pose))
        for pose, readings in zip(facing, depths, strict=True)
    ]
    best = int(np.argmin(misfits))
    pose, readings = facing[best], depths[best]
    slack_rad = 0.0
    for other, misfit in zip(facing, misfits, strict=True):
        angle = _angle_between(pose, other)
        if other is pose or misfit - misfits[best] >= _DECISIVE:
            continue
        if angle > _SAME_RAD:
            return None
        slack_rad = angle
    scale = 1.0 if readings is None else readings.scale(pose)
    if abs(scale - 1) > _SCALE_TOLERANCE:
        return SquarePose(pose, covariance_of(pose, size_m, camera), scale)
    readings = None if readings is None else readings.consistent(pose)
    pose = refine(pose, corners, size_m, camera, readings)
    covariance = covariance_of(pose, size_m, camera, readings=readings)
    covariance[3:, 3:] += np.eye(3) * slack_rad**2
    return SquarePose(pose, covariance)


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
    return pose if np.isfinite(pose).all() and pixel_misfit(pose, corners, size_m, camera) < np.inf else None


def _angle_between(a: Array, b: Array) -> float:
    cosine = (np.trace(a[:3, :3].T @ b[:3, :3]) - 1) / 2
    return float(np.arccos(np.clip(cosine, -1, 1)))
