#!/usr/bin/env python3
"""Whether simulated sequences are as hard as recorded ones: the same figures of both, as a Markdown table.

    benchmarks/simulated_statistics.py recorded/fr1_xyz drawn:desk-1
    benchmarks/simulated_statistics.py recorded/kitchen drawn:kitchen-1:border_right=0.0125,border_top=0

A sequence is a folder, or `drawn:KIND-SEED[:EFFECT=NUMBER,...]`, which is simulated with --sensor and thrown
away. Figures are over frames spread evenly (--frames):

- depth noise: spread about a plane in inverse depth, fitted to windows of 13 x 13 pixels that all have
  depth; the lower quartile of the windows of each range, millimetres, so that clutter does not count
- missing: share of pixels without depth
- features: FAST corners at a threshold of 20 with non-maximum suppression
- on walls: share of those with depth that lie on a large upright plane (found in the depth image)
- blur: median over frames of the width of edges, pixels: contrast over gradient at the strongest 2 % of them
- survival: share of 1,000 ORB features with depth, in view 10 frames later by the true poses, that have a
  like descriptor (at most 64 of 256 bits) there within 12 px of their place: as a tracker looks for them
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2 as opencv
import numpy as np
import numpy.typing as npt

from vsgraphs.datasets import open_sequence
from vsgraphs.datasets.sequence import Sequence
from vsgraphs.lens import depth_metres, distort, undistort
from vsgraphs.plans import drawn
from vsgraphs.simulate import Output, simulate
from vsgraphs.simulate.camera import parse_effects

cv2: Any = opencv  # its own stubs name neither all of its functions nor their arrays
RANGES_M = ((0.6, 1.0), (1.0, 1.5), (1.5, 2.0), (2.0, 2.5), (2.5, 3.5))
WINDOW_PX, STEP_PX = 13, 11
Image = npt.NDArray[np.uint8]
Depth = npt.NDArray[np.float32]


@dataclass
class Figures:
    """Of one sequence."""

    noise_mm: list[float]
    missing: float
    features: float
    on_walls: float
    blur_px: float
    survival: float

    def row(self, name: str) -> str:
        """Of the table."""
        noise = " | ".join("-" if np.isnan(value) else f"{value:.1f}" for value in self.noise_mm)
        return (
            f"| {name} | {noise} | {self.missing:.3f} | {self.features:.0f} | "
            f"{self.on_walls:.2f} | {self.blur_px:.2f} | {self.survival:.2f} |"
        )


def plane_spreads(depth: Depth) -> Iterator[tuple[float, float]]:
    """(range, spread) of flat windows, metres."""
    offsets = np.arange(WINDOW_PX) - WINDOW_PX // 2
    u, v = np.meshgrid(offsets, offsets)
    design = np.stack([u.ravel(), v.ravel(), np.ones(u.size)], axis=1)
    project = np.eye(u.size) - design @ np.linalg.pinv(design)
    for row in range(0, depth.shape[0] - WINDOW_PX, STEP_PX):
        for column in range(0, depth.shape[1] - WINDOW_PX, STEP_PX):
            window = depth[row : row + WINDOW_PX, column : column + WINDOW_PX].ravel()
            if not (window > 0).all():
                continue
            z = float(window.mean())
            left = project @ (1 / window)
            yield z, float(np.sqrt((left**2).sum() / (u.size - 3))) * z * z


def edge_width(grey: Image) -> float:
    """Contrast over gradient where the image changes most, pixels."""
    smooth = cv2.GaussianBlur(grey, (0, 0), 0.7).astype(np.float32)
    gradient = np.hypot(cv2.Sobel(smooth, cv2.CV_32F, 1, 0) / 8, cv2.Sobel(smooth, cv2.CV_32F, 0, 1) / 8)
    kernel = np.ones((9, 9), np.uint8)
    contrast = cv2.dilate(smooth, kernel) - cv2.erode(smooth, kernel)
    strongest = gradient > np.quantile(gradient, 0.98)
    return float(np.median(contrast[strongest] / gradient[strongest]))


def rays_of(camera: Any, shape: tuple[int, ...]) -> npt.NDArray[np.float64]:
    """(h, w, 3), z = 1, the lens taken out."""
    v, u = np.indices(shape[:2])
    x, y = undistort(camera, u, v)
    return np.stack([x, y, np.ones_like(x)], axis=-1)


def share_on_walls(
    corners: npt.NDArray[Any], depth: Depth, rays: npt.NDArray[np.float64], up: npt.NDArray[np.float64]
) -> float:
    """Of corners (n, 2) with depth, those near an upright plane that holds 8 % of all depth or more."""
    u, v = np.round(corners).astype(int).T
    points = rays[::6, ::6][depth[::6, ::6] > 0] * depth[::6, ::6][depth[::6, ::6] > 0][:, None]
    z = depth[v, u]
    places = (rays[v, u] * z[:, None])[z > 0]
    draw, taken = np.random.default_rng(0), np.zeros(len(places), bool)
    left = points
    for _ in range(4):
        best, plane = 0, None
        for _ in range(150):
            a, b, c = left[draw.integers(len(left), size=3)]
            n = np.cross(b - a, c - a)
            if np.linalg.norm(n) < 1e-6 or abs(n @ up) > 0.3 * np.linalg.norm(n):
                continue
            n /= np.linalg.norm(n)
            count = int((np.abs((left - a) @ n) < 0.006 * left[:, 2] ** 2 + 0.004).sum())
            if count > best:
                best, plane = count, (a, n)
        if plane is None or best < 0.08 * len(points):
            break
        a, n = plane
        taken |= np.abs((places - a) @ n) < 0.006 * places[:, 2] ** 2 + 0.004
        left = left[np.abs((left - a) @ n) > 0.006 * left[:, 2] ** 2 + 0.004]
        if len(left) < 50:
            break
    return float(taken.mean()) if len(places) else 0.0


def survival(
    greys: list[Image], depth: Depth, camera: Any, rays: npt.NDArray[np.float64], later_from_now: Any
) -> float:
    """Of the first image's features, those found again in the last."""
    orb = cv2.ORB_create(nfeatures=1000, fastThreshold=12)
    (now, bits), (later, others) = (orb.detectAndCompute(grey, None) for grey in (greys[0], greys[-1]))
    if bits is None or others is None:
        return 0.0
    here = np.array([point.pt for point in now])
    u, v = np.round(here).astype(int).T
    z = depth[v, u]
    moved = (rays[v, u] * z[:, None]) @ later_from_now[:3, :3].T + later_from_now[:3, 3]
    x, y = distort(camera, *(moved[:, :2] / np.maximum(moved[:, 2:], 0.05)).T)
    height, width = greys[0].shape
    seen = (z > 0) & (moved[:, 2] > 0.1) & (x > 20) & (y > 20) & (x < width - 20) & (y < height - 20)
    there = np.array([point.pt for point in later])
    found = 0
    for i in np.flatnonzero(seen):
        near = np.hypot(there[:, 0] - x[i], there[:, 1] - y[i]) < 12
        if near.any():
            differ = np.unpackbits(others[near] ^ bits[i], axis=1).sum(axis=1)
            found += int(differ.min() <= 64)
    return found / max(1, int(seen.sum()))


def upwards(sequence: Sequence) -> npt.NDArray[np.float64]:
    """The world's axis that is nearest to upwards in the images."""
    poses = poses_of(sequence, np.arange(0, len(sequence.frames), 20))
    up = -np.mean([pose[:3, 1] for pose in poses], axis=0)
    axis = np.zeros(3)
    axis[np.argmax(np.abs(up))] = np.sign(up[np.argmax(np.abs(up))])
    return axis


def poses_of(sequence: Sequence, indices: npt.NDArray[Any]) -> list[npt.NDArray[np.float64]]:
    """World from camera of frames, the nearest true ones."""
    truth = sequence.groundtruth
    if truth is None:
        raise SystemExit(f"error: {sequence.path} has no groundtruth.txt")
    out = []
    for index in indices:
        k = int(np.argmin(np.abs(truth.timestamps - sequence.frames[index].timestamp)))
        out.append(truth.poses[k])
    return out


def quartile_mm(spreads: npt.NDArray[Any]) -> float:
    """The lower quartile; not a number where there are too few windows."""
    return float(np.quantile(spreads, 0.25)) * 1000 if len(spreads) > 50 else float("nan")


def figures(sequence: Sequence, frames: int) -> Figures:
    """Reads `frames` places of a sequence, with ten frames after each."""
    fast = cv2.FastFeatureDetector_create(threshold=20)
    last = len(sequence.frames) - 12
    spreads: list[tuple[float, float]] = []
    rows: list[tuple[float, ...]] = []
    up, camera = upwards(sequence), sequence.camera
    for index in np.linspace(0, max(0, last), frames).astype(int):
        pictures = [sequence.frames[i].load() for i in (index, min(index + 10, len(sequence.frames) - 1))]
        greys = [cv2.cvtColor(np.ascontiguousarray(rgb), cv2.COLOR_RGB2GRAY) for rgb, _ in pictures]
        depth = depth_metres(pictures[0][1], camera)
        rays = rays_of(camera, depth.shape)
        now, later = poses_of(sequence, np.array([index, min(index + 10, len(sequence.frames) - 1)]))
        spreads += plane_spreads(depth)
        corners = np.array([point.pt for point in fast.detect(greys[0])])
        walls = share_on_walls(corners, depth, rays, now[:3, :3].T @ up)
        alive = survival(greys, depth, camera, rays, np.linalg.inv(later) @ now)
        rows.append((float((depth <= 0).mean()), len(corners), walls, edge_width(greys[0]), alive))
    z, s = np.array(spreads).T
    noise = [quartile_mm(s[(z >= low) & (z < high)]) for low, high in RANGES_M]
    missing, features, walls, _, alive = np.mean(rows, axis=0)
    blur = float(np.median([row[3] for row in rows]))
    return Figures(noise, float(missing), float(features), float(walls), blur, float(alive))


def opened(name: str, sensor: str, most: int, folder: Path) -> Sequence:
    """A folder's sequence, or a drawn one."""
    if not name.startswith("drawn:"):
        return open_sequence(Path(name))
    place, _, given = name.removeprefix("drawn:").partition(":")
    kind, seed = place.rsplit("-", 1)
    out = folder / name.replace(":", "_")
    effects = parse_effects(given.split(",")) if given else {}
    output = Output(labels_every=0)
    simulate(drawn(kind, int(seed)), out, sensor=sensor, effects=effects, frames=most, output=output)
    return open_sequence(out)


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("sequences", nargs="+", metavar="FOLDER|drawn:KIND-SEED")
    parser.add_argument("--sensor", default="kinect1", help="of drawn sequences")
    parser.add_argument("--frames", type=int, default=25, help="places looked at, of each sequence")
    parser.add_argument("--most", type=int, default=900, help="frames simulated, of each drawn sequence")
    options = parser.parse_args()
    ranges = " | ".join(f"{low:g}-{high:g} m" for low, high in RANGES_M)
    print(f"| sequence | noise, mm: {ranges} | missing | features | on walls | blur, px | survival |")
    print("|---|" + "---:|" * (len(RANGES_M) + 5))
    with tempfile.TemporaryDirectory() as folder:
        for name in options.sequences:
            sequence = opened(name, options.sensor, options.most, Path(folder))
            print(figures(sequence, options.frames).row(Path(name).name), flush=True)


if __name__ == "__main__":
    main()
