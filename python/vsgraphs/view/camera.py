"""What a frame shows of the map: landmarks in its image, the class of its pixels. Plain arrays."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vsgraphs.datasets import Calibration
from vsgraphs.lens import distort, undistort
from vsgraphs.trajectory import Array

NEAR_M = 0.1
_AGREES_M, _AGREES_SHARE = 0.05, 0.02  # how far a landmark may lie from the depth at its pixel


def pixel_rays(camera: Calibration, stride: int) -> Array:
    """(h, w, 2) normalised image coordinates of every stride-th pixel, the lens taken out by fixed point."""
    u, v = np.meshgrid(np.arange(0, camera.width, stride), np.arange(0, camera.height, stride))
    return np.stack(undistort(camera, u, v), axis=-1)


def back_project(
    rays: Array, depth_m: npt.NDArray[np.float32], stride: int
) -> tuple[Array, npt.NDArray[np.bool_]]:
    """(P, 3) camera coordinates of the pixels of `pixel_rays` that have depth, and (h, w) which those are."""
    z = depth_m[::stride, ::stride]
    known = z > 0
    xy = rays[known] * z[known, None]
    return np.concatenate([xy, z[known, None]], axis=1), known


def landmarks_in_view(
    camera: Calibration, depth_m: npt.NDArray[np.float32], camera_from_map: Array, points: Array
) -> tuple[Array, npt.NDArray[np.int64]]:
    """(L, 2) pixels and (L,) indices of the (M, 3) map points that the frame sees.

    That is: in the image, and as far away as its depth says, to 5 cm + 2 %.
    """
    p = points @ camera_from_map[:3, :3].T + camera_from_map[:3, 3]
    index = np.flatnonzero(p[:, 2] > NEAR_M)
    p = p[index]
    u, v = distort(camera, p[:, 0] / p[:, 2], p[:, 1] / p[:, 2])
    within = (u > -0.5) & (u < camera.width - 0.5) & (v > -0.5) & (v < camera.height - 0.5)
    index, p, u, v = index[within], p[within], u[within], v[within]
    measured = depth_m[np.rint(v).astype(int), np.rint(u).astype(int)]
    agrees = np.abs(measured - p[:, 2]) < _AGREES_M + _AGREES_SHARE * p[:, 2]
    return np.stack([u, v], axis=1)[agrees], index[agrees]
