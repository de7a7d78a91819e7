#!/usr/bin/env python3
"""Whether simulated sequences are as hard as recorded ones: the same figures of both, as a Markdown table.

    benchmarks/simulated_statistics.py recorded/fr1_xyz recorded/kitchen drawn:flat-1 drawn:office-1

A sequence is a folder, or `drawn:KIND-SEED`, which is simulated with --sensor and thrown away. Figures are
over frames spread evenly (--frames):

- depth noise: spread about a plane in inverse depth, fitted to windows of 13 x 13 pixels that all have
  depth; the lower quartile of the windows of each range, millimetres, so that clutter does not count
- missing: share of pixels without depth
- features: FAST corners at a threshold of 20 with non-maximum suppression
- blur: median over frames of the width of edges, pixels: contrast over gradient at the strongest 2 % of them
- survival: share of 400 corners that are followed over 10 frames (30 per second), there and back within 1 px
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import cv2 as opencv
import numpy as np
import numpy.typing as npt

from vsgraphs.datasets import open_sequence
from vsgraphs.datasets.sequence import Sequence
from vsgraphs.lens import depth_metres
from vsgraphs.plans import drawn
from vsgraphs.simulate import Output, simulate

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
    blur_px: float
    survival: float

    def row(self, name: str) -> str:
        """Of the table."""
        noise = " | ".join("-" if np.isnan(value) else f"{value:.1f}" for value in self.noise_mm)
        return (
            f"| {name} | {noise} | {self.missing:.3f} | {self.features:.0f} | {self.blur_px:.2f} | "
            f"{self.survival:.2f} |"
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


def survival(images: list[Image]) -> float:
    """Share of corners of the first image that are followed to the last and back."""
    first = cv2.goodFeaturesToTrack(images[0], 400, 0.005, 8)
    if first is None:
        return 0.0
    points, alive = first, np.ones(len(first), bool)
    for way in (images, images[::-1]):
        for a, b in pairwise(way):
            points, found, _ = cv2.calcOpticalFlowPyrLK(a, b, points, None, winSize=(15, 15), maxLevel=3)
            alive &= found.ravel() > 0
    back = np.linalg.norm((points - first).reshape(-1, 2), axis=1)
    return float((alive & (back < 1)).mean())


def quartile_mm(spreads: npt.NDArray[Any]) -> float:
    """The lower quartile; not a number where there are too few windows."""
    return float(np.quantile(spreads, 0.25)) * 1000 if len(spreads) > 50 else float("nan")


def figures(sequence: Sequence, frames: int) -> Figures:
    """Reads `frames` places of a sequence, with ten frames after each."""
    fast = cv2.FastFeatureDetector_create(threshold=20)
    last = len(sequence.frames) - 12
    spreads: list[tuple[float, float]] = []
    rows: list[tuple[float, ...]] = []
    for index in np.linspace(0, max(0, last), frames).astype(int):
        pictures = [sequence.frames[i].load() for i in range(index, min(index + 11, len(sequence.frames)))]
        greys = [cv2.cvtColor(np.ascontiguousarray(rgb), cv2.COLOR_RGB2GRAY) for rgb, _ in pictures]
        depth = depth_metres(pictures[0][1], sequence.camera)
        spreads += plane_spreads(depth)
        corners = float(len(fast.detect(greys[0])))
        rows.append((float((depth <= 0).mean()), corners, edge_width(greys[0]), survival(greys)))
    z, s = np.array(spreads).T
    noise = [quartile_mm(s[(z >= low) & (z < high)]) for low, high in RANGES_M]
    missing, features, _, alive = np.mean(rows, axis=0)
    return Figures(
        noise, float(missing), float(features), float(np.median([row[2] for row in rows])), float(alive)
    )


def opened(name: str, sensor: str, most: int, folder: Path) -> Sequence:
    """A folder's sequence, or a drawn one."""
    if not name.startswith("drawn:"):
        return open_sequence(Path(name))
    kind, seed = name.removeprefix("drawn:").rsplit("-", 1)
    out = folder / name.replace(":", "_")
    simulate(drawn(kind, int(seed)), out, sensor=sensor, frames=most, output=Output(labels_every=0))
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
    print(f"| sequence | noise, mm: {ranges} | missing | features | blur, px | survival |")
    print("|---|" + "---:|" * (len(RANGES_M) + 4))
    with tempfile.TemporaryDirectory() as folder:
        for name in options.sequences:
            sequence = opened(name, options.sensor, options.most, Path(folder))
            print(figures(sequence, options.frames).row(Path(name).name), flush=True)


if __name__ == "__main__":
    main()
