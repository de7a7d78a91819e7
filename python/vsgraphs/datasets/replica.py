"""Replica (Straub et al., 2019) as rendered for NICE-SLAM (Zhu et al., CVPR 2022) and used by many since.

Layout: `results/frameXXXXXX.jpg`, `results/depthXXXXXX.png` (6553.5 units per metre), `traj.txt` (one 4x4
world_from_camera per line, row by row); `cam_params.json` beside it or one folder up. There are no
timestamps: frame number / 30.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from vsgraphs.datasets.calibration import Calibration, check_calibration
from vsgraphs.datasets.cameras import CAMERAS, choose_camera
from vsgraphs.datasets.sequence import FrameRef, RecordedSequence
from vsgraphs.errors import InputError
from vsgraphs.reading import read_json, shortened
from vsgraphs.trajectory import Trajectory, read_number_rows, trajectory_from_matrices

NAME = "Replica"
LOOKED_FOR = "traj.txt and results/frameXXXXXX.jpg"
FRAMES_PER_S = 30.0

_COLOUR = re.compile(r"frame(\d+)\.(jpg|png)$")


def detect(folder: Path) -> bool:
    """Whether the folder looks like this format."""
    return (folder / "traj.txt").is_file() and (folder / "results").is_dir()


def open_folder(folder: Path, camera: str | Path | Calibration | None = None) -> RecordedSequence:
    """Opens the sequence; raises InputError when nothing in it can be used."""
    calibration, remarks = choose_camera(folder, camera, _published_camera(folder))
    size = (calibration.width, calibration.height)
    frames = []
    for path in sorted((folder / "results").iterdir()):
        match = _COLOUR.match(path.name)
        if match:
            depth = path.with_name(f"depth{match[1]}.png")
            frames.append(FrameRef(int(match[1]) / FRAMES_PER_S, path, depth, size))
    if not frames:
        raise InputError(f"{folder / 'results'}: no frameXXXXXX.jpg there")
    frames.sort(key=lambda frame: frame.timestamp)
    truth = folder / "traj.txt"
    return RecordedSequence(folder, NAME, calibration, frames, lambda: read_truth(truth), {}, remarks)


def read_truth(path: Path) -> Trajectory:
    """`traj.txt`, line k being frame k."""
    rows = read_number_rows(path, 16, "a pose of Replica (4x4 matrix, row by row)")
    return trajectory_from_matrices(np.arange(len(rows)) / FRAMES_PER_S, rows.reshape(-1, 4, 4), path.name)


def _published_camera(folder: Path) -> Calibration:
    for path in (folder / "cam_params.json", folder.resolve().parent / "cam_params.json"):
        if path.is_file():
            return _read_cam_params(path)
    return CAMERAS["replica"]


def _read_cam_params(path: Path) -> Calibration:
    document: Any = read_json(path, "camera file")
    try:
        values = document["camera"]
        numbers = {key: float(values[key]) for key in ("w", "h", "fx", "fy", "cx", "cy", "scale")}
    except (ValueError, KeyError, TypeError) as error:
        raise InputError(
            f'{path}: expected {{"camera": {{"w", "h", "fx", "fy", "cx", "cy", "scale"}}}} '
            f"({shortened(str(error))})"
        ) from None
    camera = Calibration(
        int(numbers["w"]),
        int(numbers["h"]),
        numbers["fx"],
        numbers["fy"],
        numbers["cx"],
        numbers["cy"],
        depth_scale=numbers["scale"],
        origin=path.name,
    )
    check_calibration(camera, str(path))
    return camera
