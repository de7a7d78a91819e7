#!/usr/bin/env python3
"""Time and agreement of a segmenter on a recorded sequence.

    python benchmarks/segmenter_figures.py FOLDER onnx:model.onnx [--every 20] [--overlay picture.png]

Tells CPU and wall time per image and the share of each role; where FOLDER has labels.txt, only labelled
images are taken and each role's intersection over union with them is told. --overlay draws the first six
images with their roles, stronger where the segmenter is surer.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

import vsgraphs
from vsgraphs.segment import RecordedSegmentations, Segmentation, Segmenter, SurfaceRole, make_segmenter
from vsgraphs.segment.label_folder import LabelFolder
from vsgraphs.segment.segmentation import Rgb

# undecided, wall, ground, ceiling, door, window, other
COLOURS = np.array(
    [[0, 0, 0], [255, 80, 80], [80, 255, 80], [80, 80, 255], [255, 255, 0], [0, 255, 255], [160, 160, 160]],
    np.uint8,
)
Array = npt.NDArray[Any]


def stretched(array: Array, shape: tuple[int, ...]) -> Array:
    """The nearest element for each pixel."""
    return np.asarray(Image.fromarray(array).resize((shape[1], shape[0]), Image.Resampling.NEAREST))


def overlay(rgb: Rgb, roles: Array, confidence: Array | None) -> Array:
    """Image above, image with roles below, at half size."""
    shape = rgb.shape[:2]
    weight = np.ones(shape) if confidence is None else stretched(confidence, shape)
    drawn = 0.5 * rgb + 0.5 * COLOURS[stretched(roles, shape)] * weight[:, :, None]
    return np.vstack([rgb, drawn.astype(np.uint8)])[::2, ::2]


class Figures:
    """What is summed up over images."""

    def __init__(self) -> None:
        self.cpu_s: list[float] = []
        self.wall_s: list[float] = []
        self.pictures: list[Array] = []
        self.shares, self.both, self.either = np.zeros(7), np.zeros(7), np.zeros(7)

    def add(self, rgb: Rgb, segmenter: Segmenter, expected: Segmentation | None) -> None:
        """Segments one image."""
        cpu, wall = time.thread_time(), time.monotonic()
        found = segmenter(rgb)
        self.cpu_s.append(time.thread_time() - cpu)
        self.wall_s.append(time.monotonic() - wall)
        if len(self.pictures) < 6:
            self.pictures.append(overlay(rgb, found.roles, found.confidence))
        roles = stretched(found.roles, rgb.shape)
        self.shares += np.bincount(roles.ravel(), minlength=7) / roles.size
        if expected is not None:
            for role in range(7):
                mine, true = roles == role, expected.roles == role
                self.both[role] += np.count_nonzero(mine & true)
                self.either[role] += np.count_nonzero(mine | true)

    def tell(self) -> None:
        """Prints them."""
        for name, times in (("CPU of the calling thread", self.cpu_s), ("wall", self.wall_s)):
            median, p95 = 1e3 * np.percentile(times, [50, 95])
            print(f"{name}: {median:.0f} ms median, {p95:.0f} ms p95, {len(times)} images")
        for role in SurfaceRole:
            share = 100 * self.shares[role] / len(self.cpu_s)
            agreement = f", IoU {self.both[role] / self.either[role]:.2f}" if self.either[role] else ""
            print(f"{role.name}: {share:.1f} % of the pixels{agreement}")


def main() -> None:
    """Reads the arguments, prints the figures."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("segmenter")
    parser.add_argument("--every", type=int, default=20)
    parser.add_argument("--overlay", type=Path)
    given = parser.parse_args()
    segmenter = make_segmenter(given.segmenter)
    if segmenter is None or isinstance(segmenter, RecordedSegmentations):
        parser.error("give a segmenter that is called with images, e.g. onnx:FILE")
    frames = vsgraphs.open_sequence(given.folder).frames
    truth = LabelFolder(given.folder) if (given.folder / "labels.txt").is_file() else None
    if truth is not None:
        frames = [frame for frame in frames if truth.at(frame.timestamp) is not None]
    figures = Figures()
    for frame in frames[:: given.every]:
        figures.add(frame.load()[0], segmenter, None if truth is None else truth.at(frame.timestamp))
    figures.tell()
    if given.overlay:
        Image.fromarray(np.hstack(figures.pictures)).save(given.overlay)


if __name__ == "__main__":
    main()
