"""Where a camera's lens shows a point, and what its depth readings mean, without the compiled module.

camera: a `Calibration` or a `vsgraphs.Camera`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from vsgraphs.trajectory import Array


def depth_metres(depth: npt.NDArray[np.generic], camera: Any) -> npt.NDArray[np.float32]:
    """Depth image in metres, 0 where there is none; uint16 in the camera's units or float32 metres."""
    if depth.dtype != np.uint16:
        return np.nan_to_num(depth.astype(np.float32), posinf=0.0, neginf=0.0)
    out = depth.astype(np.float32) / np.float32(camera.depth_scale)
    for value in camera.invalid_depth:
        out[depth == value] = 0.0
    return out


def distort(camera: Any, x: Array, y: Array) -> tuple[Array, Array]:
    """Normalised image coordinates (x/z, y/z) -> pixels, with the lens (Brown and Conrady's model)."""
    k1, k2, p1, p2, k3 = camera.distortion
    r2 = x * x + y * y
    radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
    xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
    return camera.fx * xd + camera.cx, camera.fy * yd + camera.cy


def undistort(camera: Any, u: npt.NDArray[Any], v: npt.NDArray[Any]) -> tuple[Array, Array]:
    """Pixels -> normalised image coordinates, the lens taken out by fixed point."""
    x0 = ((u - camera.cx) / camera.fx).astype(np.float64)
    y0 = ((v - camera.cy) / camera.fy).astype(np.float64)
    x, y = x0.copy(), y0.copy()
    if any(camera.distortion):
        for _ in range(8):
            xd, yd = distort(camera, x, y)
            x, y = x + x0 - (xd - camera.cx) / camera.fx, y + y0 - (yd - camera.cy) / camera.fy
    return x, y
