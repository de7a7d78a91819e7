"""Images of lenses that the tracker's camera model does not know, turned into those of a pinhole at reading.

Kannala and Brandt, "A generic camera model" (PAMI 2006), with the odd powers of the angle up to the ninth;
rational: six radial coefficients and two tangential ones, as OpenCV's (k1 k2 p1 p2 k3 k4 k5 k6).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from vsgraphs.datasets.calibration import Calibration, LensModel

Array = npt.NDArray[np.float64]
_FRACTION_BITS = 7


def bend(lens: LensModel, x: Array, y: Array) -> tuple[Array, Array]:
    """x/z, y/z of a pinhole -> where the lens shows it: (pixel - centre) / focal length."""
    r2 = x * x + y * y
    if lens.model == "kannala_brandt":
        k1, k2, k3, k4 = lens.filled(4)
        r = np.sqrt(r2)
        theta = np.arctan(r)
        t2 = theta * theta
        bent = theta * (1 + t2 * (k1 + t2 * (k2 + t2 * (k3 + t2 * k4))))
        scale = np.where(r > 1e-12, bent / np.maximum(r, 1e-12), 1.0)
        return x * scale, y * scale
    k1, k2, p1, p2, k3, k4, k5, k6 = lens.filled(8)
    scale = (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)))
    return (
        x * scale + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
        y * scale + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y,
    )


class StraightGrid:
    """Where each pixel of the pinhole's image lies in the lens's image."""

    def __init__(self, camera: Calibration, lens: LensModel) -> None:
        """Works out the tables: about 50 ms at 640x480."""
        width, height = camera.width, camera.height
        v, u = np.indices((height, width), dtype=np.float64)
        x, y = (u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy
        bent_x, bent_y = bend(lens, x, y)
        s, t = camera.fx * bent_x + camera.cx, camera.fy * bent_y + camera.cy
        inside = (s >= 0) & (t >= 0) & (s <= width - 1) & (t <= height - 1)
        inside &= np.hypot(x, y) < _turns_back(lens)
        s, t = np.where(inside, s, 0.0), np.where(inside, t, 0.0)
        left, top = np.minimum(s.astype(np.int64), width - 2), np.minimum(t.astype(np.int64), height - 2)
        one = 1 << _FRACTION_BITS
        self._nearest = (np.round(t).astype(np.int64) * width + np.round(s).astype(np.int64)).ravel()
        self._corner = (top * width + left).ravel()
        self._across = np.round((s - left) * one).astype(np.uint16).reshape(-1, 1)
        self._down = np.round((t - top) * one).astype(np.uint16).reshape(-1, 1)
        self._outside = ~inside

    def colour(self, rgb: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
        """(h, w, 3) of the lens -> of the pinhole; black where the lens shows nothing."""
        height, width = rgb.shape[:2]
        padded = np.zeros((height, width, 4), np.uint8)
        padded[:, :, :3] = rgb
        packed = padded.view(np.uint32).ravel()
        one, half = 1 << _FRACTION_BITS, 1 << _FRACTION_BITS - 1

        def texels(shift: int) -> npt.NDArray[np.uint16]:
            return packed.take(self._corner + shift).view(np.uint8).reshape(-1, 4).astype(np.uint16)

        across, down = self._across, self._down
        upper = (texels(0) * (one - across) + texels(1) * across + half) >> _FRACTION_BITS
        lower = (texels(width) * (one - across) + texels(width + 1) * across + half) >> _FRACTION_BITS
        mixed = (upper * (one - down) + lower * down + half) >> _FRACTION_BITS
        out = np.ascontiguousarray(mixed.astype(np.uint8).reshape(height, width, 4)[:, :, :3])
        out[self._outside] = 0
        return out

    def depth(self, depth: npt.NDArray[np.uint16]) -> npt.NDArray[np.uint16]:
        """(h, w) of the lens -> of the pinhole; 0 where the lens shows nothing."""
        out = depth.ravel().take(self._nearest).reshape(depth.shape)
        out[self._outside] = 0
        return out


def _turns_back(lens: LensModel) -> float:
    """Radius x/z from which on the lens's image runs inwards again: there the model means nothing."""
    r = np.linspace(0.0, 4.0, 4001)
    bent, _ = bend(replace(lens, coefficients=_radial(lens)), r, np.zeros_like(r))
    falling = np.flatnonzero((np.diff(bent) <= 0) | ~np.isfinite(bent[1:]))
    return float(r[falling[0]]) if len(falling) else np.inf


def _radial(lens: LensModel) -> tuple[float, ...]:
    if lens.model == "kannala_brandt":
        return lens.coefficients
    k1, k2, _, _, *more = lens.filled(8)
    return (k1, k2, 0.0, 0.0, *more)
