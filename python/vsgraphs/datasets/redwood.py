"""Redwood (Choi et al., "Robust Reconstruction of Indoor Scenes", CVPR 2015) and folders recorded for Open3D.

Layout: colour in `color/`, `image/` or `rgb/`, depth in `depth/` (16 bit, millimetres, registered to colour);
`camera_intrinsic.json`, `intrinsic.json` or `camera.json` as Open3D writes it (width, height,
intrinsic_matrix column by column, perhaps depth_scale); `trajectory.log` with the true world_from_camera of
the n-th colour image: a line of three numbers, then four rows, for each. Redwood's archives come without a
camera file: its PrimeSense (fx = fy = 525) is then assumed and said. Images are named by frame number (time:
number / 30) or, as in Redwood's object scans, `number-microseconds`.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from vsgraphs.datasets.calibration import Calibration, check_calibration
from vsgraphs.datasets.cameras import CAMERAS, choose_camera
from vsgraphs.datasets.numbered import numbered_images, pair_by_number
from vsgraphs.datasets.sequence import FrameRef, RecordedSequence
from vsgraphs.errors import InputError
from vsgraphs.reading import LARGE, read_json, read_text, shortened
from vsgraphs.timestamps import pair_by_time
from vsgraphs.trajectory import Array, Trajectory, trajectory_from_matrices

NAME = "Redwood/Open3D"
LOOKED_FOR = "color/, image/ or rgb/, and depth/, with camera_intrinsic.json or trajectory.log"
FRAMES_PER_S = 30.0
MAX_GAP_S = 0.02
TRUTH = "trajectory.log"

_AS_OPEN3D = (
    'expected {"width", "height", "intrinsic_matrix": [9 numbers, column by column]} as Open3D writes it'
)
_COLOUR_FOLDERS = ("color", "image", "rgb")
_CAMERA_FILES = ("camera_intrinsic.json", "intrinsic.json", "camera.json")
_TIMED_NAME = re.compile(r"\d+-(\d+)\.(?:jpg|jpeg|png)$", re.IGNORECASE)
_OTHERS = ("rgb.txt", "color.txt", "associations.txt", "pose", "intrinsic")  # of formats that look alike


def detect(folder: Path) -> bool:
    """Whether the folder looks like this format."""
    if _colour_folder(folder) is None or any((folder / name).exists() for name in _OTHERS):
        return False
    return _camera_file(folder) is not None or (folder / TRUTH).is_file()


def open_folder(folder: Path, camera: str | Path | Calibration | None = None) -> RecordedSequence:
    """Opens the sequence; raises InputError when nothing in it can be used."""
    colour = _colour_folder(folder)
    if colour is None:
        raise InputError(f"{folder}: no color/, image/ or rgb/ beside a depth/")
    listed = _camera_file(folder)
    own = read_camera(listed) if listed is not None and not isinstance(camera, Calibration) else None
    calibration, remarks = choose_camera(folder, camera, own or CAMERAS["redwood"])
    if calibration is CAMERAS["redwood"] and camera is None:
        remarks = [
            *remarks,
            f"{folder.name}: no camera_intrinsic.json, Redwood's PrimeSense assumed (525 pixels)",
        ]
    size = (calibration.width, calibration.height)
    timed = _timed_images(colour)
    pairs, warnings = (
        _timed_pairs(timed, folder / "depth") if timed else _numbered_pairs(colour, folder / "depth")
    )
    stamps = list(timed) if timed else [number / FRAMES_PER_S for number in numbered_images(colour)]
    frames = [FrameRef(stamp, rgb, depth, size) for stamp, rgb, depth in pairs]
    truth = folder / TRUTH
    return RecordedSequence(
        folder,
        NAME,
        calibration,
        frames,
        (lambda: read_truth(truth, stamps)) if truth.is_file() else None,
        {},
        remarks + warnings,
    )


def read_truth(path: Path, stamps: list[float]) -> Trajectory:
    """`trajectory.log`: the n-th block is the pose of the n-th colour image; stamps are those, in seconds."""
    blocks = _matrices(path)
    count = min(len(blocks), len(stamps))
    truth = trajectory_from_matrices(np.array(stamps[:count]), blocks[:count], path.name)
    if len(blocks) != len(stamps):
        truth.notes.append(f"{path.name}: {len(blocks)} poses for {len(stamps)} colour images, by order")
    return truth


def read_camera(path: Path) -> Calibration:
    """Open3D's camera file. Raises InputError."""
    values: Any = read_json(path, "camera file", cure=_AS_OPEN3D)
    try:
        width, height = int(values["width"]), int(values["height"])
        matrix = np.array(values["intrinsic_matrix"], dtype=np.float64).ravel()
        scale = float(values.get("depth_scale", 1000.0))
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        reason = f"{type(error).__name__}: {shortened(str(error))}"
        raise InputError(f"{path}: {_AS_OPEN3D} ({reason})") from None
    if matrix.shape != (9,) or not np.isfinite(matrix).all():
        raise InputError(f"{path}: intrinsic_matrix has {matrix.size} numbers, expected 9 finite ones")
    if matrix[2] != 0 or matrix[5] != 0:
        raise InputError(f"{path}: intrinsic_matrix stands row by row; Open3D writes it column by column")
    camera = Calibration(
        width, height, matrix[0], matrix[4], matrix[6], matrix[7], depth_scale=scale, origin=path.name
    )
    check_calibration(camera, str(path))
    return camera


def _matrices(path: Path) -> Array:
    """(N, 4, 4), one for each block of a line of three numbers and four rows. Raises InputError."""
    text = read_text(path, "trajectory", LARGE, damaged=True)
    lines = [(number, words) for number, line in enumerate(text.splitlines(), 1) if (words := line.split())]
    rows = []
    for place, (number, words) in enumerate(lines):
        expected = 4 if place % 5 else 3
        try:
            numbers = [float(word) for word in words]
        except ValueError:
            numbers = []
        if len(numbers) != expected:
            raise InputError(
                f"{path}:{number}: expected {expected} numbers (for each pose a line of "
                "three, then four rows of four)"
            )
        if place % 5:
            rows.append(numbers)
    if not rows or len(lines) % 5:
        raise InputError(f"{path}: {len(lines)} lines, expected five for each pose; copied completely?")
    return np.array(rows).reshape(-1, 4, 4)


def _colour_folder(folder: Path) -> Path | None:
    if not (folder / "depth").is_dir():
        return None
    return next((folder / name for name in _COLOUR_FOLDERS if (folder / name).is_dir()), None)


def _camera_file(folder: Path) -> Path | None:
    return next((folder / name for name in _CAMERA_FILES if (folder / name).is_file()), None)


def _timed_images(folder: Path) -> dict[float, Path]:
    """Seconds -> image of files called number-microseconds, in order of time."""
    found = {
        int(match[1]) * 1e-6: path for path in folder.iterdir() if (match := _TIMED_NAME.match(path.name))
    }
    return dict(sorted(found.items()))


def _timed_pairs(colour: dict[float, Path], folder: Path) -> tuple[list[tuple[float, Path, Path]], list[str]]:
    depth = _timed_images(folder)
    stamps, depth_stamps = list(colour), list(depth)
    pairs = pair_by_time(stamps, depth_stamps, MAX_GAP_S)
    if not pairs:
        raise InputError(
            f"{folder}: no depth image within {MAX_GAP_S:g} s of any colour image, by their names"
        )
    alone = len(stamps) - len(pairs)
    warnings = [f"{alone} of {len(stamps)} colour images have no depth within {MAX_GAP_S:g} s, left out"]
    return (
        [(stamps[i], colour[stamps[i]], depth[depth_stamps[j]]) for i, j in pairs],
        warnings if alone else [],
    )


def _numbered_pairs(colour: Path, depth: Path) -> tuple[list[tuple[float, Path, Path]], list[str]]:
    numbered, warnings = pair_by_number(colour, depth)
    return [(number / FRAMES_PER_S, rgb, d) for number, rgb, d in numbered], warnings
