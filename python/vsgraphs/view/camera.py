"""What a frame shows of the map: landmarks in its image, the class of its pixels. Plain arrays."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vsgraphs.datasets import Calibration
from vsgraphs.trajectory import Array

NEAR_M = 0.1
_AGREES_M, _AGREES_SHARE = 0.05, 0.02  # how far a landmark may lie from the depth at its pixel


def depth_metres(depth: npt.NDArray[np.generic], camera: Calibration) -> npt.NDArray[np.float32]:
    """Depth image in metres, 0 where there is none; uint16 in the camera's units or float32 metres."""
    if depth.dtype != np.uint16:
        return np.nan_to_num(depth.astype(np.float32), posinf=0.0, neginf=0.0)
    out = depth.astype(np.float32) / np.float32(camera.depth_scale)
    for value in camera.invalid_depth:
        out[depth == value] = 0.0
    return out


def distort(camera: Calibration, x: Array, y: Array) -> tuple[Array, Array]:
    """Normalised image coordinates (x/z, y/z) -> pixels, with the lens (Brown and Conrady's model)."""
    k1, k2, p1, p2, k3 = camera.distortion
    r2 = x * x + y * y
    radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
    xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
    return camera.fx * xd + camera.cx, camera.fy * yd + camera.cy


def pixel_rays(camera: Calibration, stride: int) -> Array:
    """(h, w, 2) normalised image coordinates of every stride-th pixel, the lens taken out by fixed point."""
    u, v = np.meshgrid(np.arange(0, camera.width, stride), np.arange(0, camera.height, stride))
    x0 = ((u - camera.cx) / camera.fx).astype(np.float64)
    y0 = ((v - camera.cy) / camera.fy).astype(np.float64)
    x, y = x0.copy(), y0.copy()
    if any(camera.distortion):
        for _ in range(8):
            xd, yd = distort(camera, x, y)
            x, y = x + x0 - (xd - camera.cx) / camera.fx, y + y0 - (yd - camera.cy) / camera.fy
    return np.stack([x, y], axis=-1)


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
