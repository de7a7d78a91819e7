"""OpenLORIS-Scene, the per-sequence packages.

Shi et al., "Are We Ready for Service Robots? The OpenLORIS-Scene Datasets for Lifelong SLAM", ICRA 2020.

Layout: `color.txt` and `aligned_depth.txt` (`timestamp file`) with `color/*.png` and `aligned_depth/*.png`
(millimetres, registered to colour), `sensors.yaml` and `trans_matrix.yaml` (OpenCV's YAML), `groundtruth.txt`
(TUM lines). Of the RealSense D435i only; the fisheye camera, IMU and wheels are not read. Three things differ
from TUM: intrinsics stand as fx, cx, fy, cy; `depth/` is not registered to colour and not used; the truth is
the robot's base_link, which `trans_matrix.yaml` moves to the colour camera here.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from vsgraphs.datasets.calibration import Calibration, check_calibration
from vsgraphs.datasets.cameras import choose_camera
from vsgraphs.datasets.lists import read_timed_files
from vsgraphs.datasets.opencv_yaml import read_opencv_yaml
from vsgraphs.datasets.sequence import FrameRef, RecordedSequence
from vsgraphs.errors import InputError
from vsgraphs.reading import shortened, shown
from vsgraphs.timestamps import pair_by_time, smallest_gap
from vsgraphs.trajectory import Array, Trajectory, read_tum_trajectory

NAME = "OpenLORIS-Scene"
LOOKED_FOR = "color.txt, aligned_depth.txt and sensors.yaml"
MAX_GAP_S = 0.017  # half a frame: the two images of a pair are some microseconds apart
TRUTH = "groundtruth.txt"

_CAMERA = "d400_color_optical_frame"
_BODY = "base_link"
_TRANSFORMS = "trans_matrix.yaml"


def detect(folder: Path) -> bool:
    """Whether the folder looks like this format."""
    return (folder / "color.txt").is_file() and any(
        (folder / name).is_file() for name in ("sensors.yaml", "aligned_depth.txt", _TRANSFORMS)
    )


def open_folder(folder: Path, camera: str | Path | Calibration | None = None) -> RecordedSequence:
    """Opens the sequence; raises InputError when nothing in it can be used."""
    if not (folder / "aligned_depth.txt").is_file():
        raise InputError(
            f"{folder / 'aligned_depth.txt'} is missing: only depth registered to colour can be used "
            "(depth.txt is not)"
        )
    calibration, remarks = choose_camera(folder, camera, lambda: read_camera(folder))
    frames, skipped, warnings = _frames(folder, (calibration.width, calibration.height))
    truth = folder / TRUTH
    return RecordedSequence(
        folder,
        NAME,
        calibration,
        frames,
        (lambda: read_truth(truth)) if truth.is_file() else None,
        skipped,
        remarks + warnings,
    )


def read_camera(folder: Path) -> Calibration:
    """The colour camera of `sensors.yaml`. Raises InputError naming what is missing."""
    path = folder / "sensors.yaml"
    if not path.is_file():
        raise InputError(f"{path} is missing; it comes with each package, or give --camera FILE")
    sensor = read_opencv_yaml(path).get(_CAMERA)
    if not isinstance(sensor, dict):
        raise InputError(f"{path}: no sensor {_CAMERA}")
    fx, cx, fy, cy = _numbers(sensor, "intrinsics", 4, path)
    lens = (
        _numbers(sensor, "distortion_coefficients", 5, path)
        if "distortion_coefficients" in sensor
        else [0.0] * 5
    )
    camera = Calibration(
        int(_number(sensor, "width", path)),
        int(_number(sensor, "height", path)),
        fx,
        fy,
        cx,
        cy,
        (lens[0], lens[1], lens[2], lens[3], lens[4]),
        fps=_number(sensor, "fps", path),
        depth_scale=1000.0,
        origin="sensors.yaml",
    )
    check_calibration(camera, f"{path}: {_CAMERA}")
    return camera


def read_truth(path: Path) -> Trajectory:
    """`groundtruth.txt` moved from the robot's base to its colour camera, world_from_camera."""
    trajectory = read_tum_trajectory(path)
    trajectory.poses = trajectory.poses @ base_from_camera(path.parent / _TRANSFORMS)
    trajectory.notes.append(f"{path.name}: moved from {_BODY} to the colour camera by {_TRANSFORMS}")
    return trajectory


def base_from_camera(path: Path) -> Array:
    """(4, 4): camera coordinates to the robot's, along the chain of parents. Raises InputError."""
    if not path.is_file():
        raise InputError(f"{path} is missing: without it the truth ({_BODY}) cannot be moved to the camera")
    rows = read_opencv_yaml(path).get("trans_matrix")
    if not isinstance(rows, list):
        raise InputError(f"{path}: no list trans_matrix")
    parents = {}
    for row in rows:
        matrix = row.get("matrix") if isinstance(row, dict) else None
        if not isinstance(matrix, np.ndarray) or matrix.shape != (4, 4) or not np.isfinite(matrix).all():
            raise InputError(f"{path}: an entry of trans_matrix has no finite 4x4 matrix")
        parents[str(row.get("child_frame"))] = (str(row.get("parent_frame")), matrix)
    pose, frame, seen = np.eye(4), _CAMERA, set()
    while frame != _BODY:
        if frame not in parents or frame in seen:
            raise InputError(
                f"{path}: no chain of frames from {_CAMERA} to {_BODY} (ends at {shortened(frame)})"
            )
        seen.add(frame)
        frame, parent_from_child = parents[frame]
        pose = parent_from_child @ pose
    return pose


def _frames(folder: Path, size: tuple[int, int]) -> tuple[list[FrameRef], dict[str, int], list[str]]:
    colour = read_timed_files(folder / "color.txt")
    depth = read_timed_files(folder / "aligned_depth.txt")
    pairs = pair_by_time(colour.stamps, depth.stamps, MAX_GAP_S)
    if not pairs:
        gap = smallest_gap(colour.stamps, depth.stamps)
        raise InputError(
            f"{folder}: no images of color.txt and aligned_depth.txt are within {MAX_GAP_S:g} s of each "
            f"other; the smallest gap is {gap:g} s"
        )
    warnings = colour.warnings + depth.warnings
    alone = len(colour.stamps) - len(pairs)
    if alone:
        warnings.append(f"color.txt: {alone} of {len(colour.stamps)} images have no aligned depth, left out")
    frames = [
        FrameRef(colour.stamps[i], folder / colour.items[i], folder / depth.items[j], size) for i, j in pairs
    ]
    return frames, colour.skipped, warnings


def _number(sensor: dict[str, Any], key: str, path: Path) -> float:
    value = sensor.get(key)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise InputError(f"{path}: {_CAMERA}: {key} is {shown(value)}, expected a number")
    return float(value)


def _numbers(sensor: dict[str, Any], key: str, count: int, path: Path) -> list[float]:
    value = sensor.get(key)
    if not isinstance(value, np.ndarray) or value.size < count or not np.isfinite(value).all():
        raise InputError(f"{path}: {_CAMERA}: {key} must be a matrix of {count} finite numbers")
    return [float(number) for number in value.ravel()[:count]]
