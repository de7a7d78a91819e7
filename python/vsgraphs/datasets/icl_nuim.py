"""ICL-NUIM, the release called TUM RGB-D compatible PNGs.

Handa et al., "A Benchmark for RGB-D Visual Odometry, 3D Reconstruction and SLAM", ICRA 2014. Layout:
`rgb/N.png`, `depth/N.png` (5000 units per metre), `associations.txt` (`N depth/N.png N rgb/N.png`) and
`livingRoom*.gt.freiburg` or `traj*.gt.freiburg`. Three things differ from TUM:
- Timestamps are frame numbers. Here they become seconds at the published 30 frames/s, the truth's too.
- The renderer's world and camera have y up, hence the published fy = -480. The images are stored top row
  first,
  so they are used with fy = +480, y down, and the true poses are mirrored to match: T -> S T S with
  S = diag(1, -1, 1, 1). Unmirrored, no rigid alignment could lay the two trajectories on each other.
- Nothing is paired by time.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from vsgraphs.datasets import tum
from vsgraphs.datasets.calibration import Calibration
from vsgraphs.datasets.cameras import CAMERAS, choose_camera
from vsgraphs.datasets.sequence import FrameRef, RecordedSequence
from vsgraphs.errors import InputError
from vsgraphs.reading import read_head
from vsgraphs.trajectory import Trajectory, read_tum_trajectory

NAME = "ICL-NUIM"
LOOKED_FOR = "associations.txt of frame numbers with *.gt.freiburg"
FRAMES_PER_S = 30.0
TRUTH_SUFFIX = ".gt.freiburg"

_CONVENTION = (
    "ICL-NUIM: results are in seconds (frame number / 30) and with y down, unlike its *.gt.freiburg; "
    "`vsgraphs eval` converts those"
)


def detect(folder: Path) -> bool:
    """Whether the folder looks like this format."""
    listed = tum.association_file(folder)
    if listed is None:
        return False
    return truth_file(folder) is not None or _stamps_are_frame_numbers(listed)


def open_folder(folder: Path, camera: str | Path | Calibration | None = None) -> RecordedSequence:
    """Opens the sequence; raises InputError when nothing in it can be used."""
    calibration, remarks = choose_camera(folder, camera, CAMERAS["icl-nuim"], y_up=True)
    listed = tum.association_file(folder)
    if listed is None:
        raise InputError(f"{folder}: no associations.txt there")
    timed = tum.read_associations(listed)
    size = (calibration.width, calibration.height)
    frames = [
        FrameRef(number / FRAMES_PER_S, folder / rgb, folder / depth, size)
        for number, (rgb, depth) in zip(timed.stamps, timed.items, strict=True)
    ]
    truth = truth_file(folder)
    return RecordedSequence(
        folder,
        NAME,
        calibration,
        frames,
        (lambda: read_truth(truth)) if truth else None,
        timed.skipped,
        [*remarks, _CONVENTION, *timed.warnings],
    )


def truth_file(folder: Path) -> Path | None:
    """The published true trajectory in the folder, if any."""
    return next(iter(sorted(folder.glob("*" + TRUTH_SUFFIX))), None)


def read_truth(path: Path) -> Trajectory:
    """`*.gt.freiburg` in seconds and with y down: comparable to what tracking the images gives."""
    trajectory = read_tum_trajectory(path)
    mirror = np.diag([1.0, -1.0, 1.0, 1.0])
    trajectory.poses = mirror @ trajectory.poses @ mirror
    trajectory.timestamps = trajectory.timestamps / FRAMES_PER_S
    trajectory.notes.append(f"{path.name}: frame numbers read as {FRAMES_PER_S:g} per second, y turned down")
    return trajectory


def _stamps_are_frame_numbers(listed: Path) -> bool:
    lines = read_head(listed, "list").splitlines()
    first = next((line.split() for line in lines if line.strip() and not line.startswith("#")), [])
    return len(first) >= 4 and first[0].isdigit() and Path(first[1]).stem == first[0]
