"""7-Scenes (Shotton et al., "Scene Coordinate Regression Forests", CVPR 2013), the raw release.

Layout: `frame-XXXXXX.color.png`, `frame-XXXXXX.depth.png` (millimetres, 65535 = none),
`frame-XXXXXX.pose.txt` (4x4 world_from_camera of the depth camera) in one folder per sequence (`seq-01`).
There are no timestamps: frame number / 30. Colour and depth are not registered to each other in this
release (a few pixels).
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from vsgraphs.datasets.calibration import Calibration
from vsgraphs.datasets.cameras import CAMERAS, choose_camera
from vsgraphs.datasets.sequence import FrameRef, RecordedSequence
from vsgraphs.errors import InputError
from vsgraphs.reading import read_text
from vsgraphs.trajectory import Trajectory, trajectory_from_matrices

NAME = "7-Scenes"
LOOKED_FOR = "frame-XXXXXX.color.png and frame-XXXXXX.depth.png"
FRAMES_PER_S = 30.0

_COLOUR = re.compile(r"frame-(\d+)\.color\.(png|jpg)$")


def detect(folder: Path) -> bool:
    """Whether the folder looks like this format."""
    return any(folder.glob("frame-*.color.*"))


def open_folder(folder: Path, camera: str | Path | Calibration | None = None) -> RecordedSequence:
    """Opens the sequence; raises InputError when nothing in it can be used."""
    calibration, remarks = choose_camera(folder, camera, CAMERAS["7-scenes"])
    size = (calibration.width, calibration.height)
    numbered = _numbered(folder, _COLOUR)
    frames = [
        FrameRef(number / FRAMES_PER_S, colour, colour.with_name(f"frame-{digits}.depth.png"), size)
        for number, digits, colour in numbered
    ]
    if not frames:
        raise InputError(f"{folder}: no frame-XXXXXX.color.png there")
    poses = [
        (number / FRAMES_PER_S, colour.with_name(f"frame-{digits}.pose.txt"))
        for number, digits, colour in numbered
    ]
    has_truth = any(path.is_file() for _, path in poses)
    return RecordedSequence(
        folder,
        NAME,
        calibration,
        frames,
        (lambda: _read_poses(poses, folder.name)) if has_truth else None,
        {},
        remarks,
    )


def _numbered(folder: Path, pattern: re.Pattern[str]) -> list[tuple[int, str, Path]]:
    found = []
    for path in folder.iterdir():
        match = pattern.match(path.name)
        if match:
            found.append((int(match[1]), match[1], path))
    return sorted(found)


def _read_poses(files: list[tuple[float, Path]], source: str) -> Trajectory:
    stamps, poses = [], []
    for stamp, path in files:
        if not path.is_file():
            continue
        text = read_text(path, "pose", damaged=True)
        try:
            numbers = [float(word) for word in text.split()]
        except ValueError:
            raise InputError(f"{path}: not a 4x4 matrix of numbers") from None
        if len(numbers) != 16:
            raise InputError(f"{path}: {len(numbers)} numbers, expected a 4x4 matrix")
        stamps.append(stamp)
        poses.append(numbers)
    return trajectory_from_matrices(np.array(stamps), np.array(poses).reshape(-1, 4, 4), source)
