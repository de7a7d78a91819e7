"""TUM RGB-D (Sturm et al., "A Benchmark for the Evaluation of RGB-D SLAM Systems", IROS 2012).

Layout: `rgb.txt` and `depth.txt` (`timestamp file`), paired one-to-one by nearest timestamp; or
`associations.txt` (`timestamp rgb timestamp depth`, either order) which then decides. `groundtruth.txt`
optional. The frame's time is its colour image's. Camera: `camera.yaml`, or known by the folder's name
(freiburg1, ...).
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from vsgraphs.datasets.calibration import Calibration
from vsgraphs.datasets.cameras import choose_camera
from vsgraphs.datasets.lists import (
    Timed,
    in_order,
    read_list,
    read_timed_files,
    stamp_of,
)
from vsgraphs.datasets.sequence import FrameRef, RecordedSequence
from vsgraphs.errors import InputError
from vsgraphs.timestamps import pair_by_time, smallest_gap

if TYPE_CHECKING:
    from vsgraphs.trajectory import Trajectory

NAME = "TUM RGB-D"
LOOKED_FOR = "associations.txt, or rgb.txt and depth.txt"
MAX_GAP_S = 0.02

_ASSOCIATIONS = ("associations.txt", "association.txt", "associate.txt", "associated.txt")


def detect(folder: Path) -> bool:
    """Whether the folder looks like this format."""
    return association_file(folder) is not None or (
        (folder / "rgb.txt").is_file() and (folder / "depth.txt").is_file()
    )


def open_folder(folder: Path, camera: str | Path | Calibration | None = None) -> RecordedSequence:
    """Opens the sequence; raises InputError when nothing in it can be used."""
    calibration, remarks = choose_camera(folder, camera, None)
    listed = association_file(folder)
    timed = read_associations(listed) if listed else _pair_lists(folder)
    size = (calibration.width, calibration.height)
    frames = [
        FrameRef(stamp, folder / rgb, folder / depth, size)
        for stamp, (rgb, depth) in zip(timed.stamps, timed.items, strict=True)
    ]
    truth = folder / "groundtruth.txt"
    return RecordedSequence(
        folder,
        NAME,
        calibration,
        frames,
        (lambda: _read_truth(truth)) if truth.is_file() else None,
        timed.skipped,
        remarks + timed.warnings,
    )


def _read_truth(path: Path) -> Trajectory:
    from vsgraphs.trajectory import read_tum_trajectory

    return read_tum_trajectory(path)


def association_file(folder: Path) -> Path | None:
    """The file of ready-made pairs, if there is one."""
    return next((folder / name for name in _ASSOCIATIONS if (folder / name).is_file()), None)


def read_associations(path: Path) -> Timed[tuple[str, str]]:
    """`associations.txt` -> (rgb, depth) by colour timestamp; the file names tell the columns apart."""
    stamps: list[float] = []
    pairs: list[tuple[str, str]] = []
    for row in read_list(path, 4):
        depth_first = "depth" in row[1].lower() and "depth" not in row[3].lower()
        rgb, depth = (2, 0) if depth_first else (0, 2)
        stamps.append(stamp_of(row[rgb], path))
        pairs.append((row[rgb + 1], row[depth + 1]))
    if not stamps:
        raise InputError(f"{path} lists no frames; expected lines 'timestamp rgb timestamp depth'")
    timed = in_order(stamps, pairs, path.name)
    if not timed.stamps:
        raise InputError(f"{path}: none of the {len(stamps)} timestamps is a number of seconds")
    return timed


def _pair_lists(folder: Path) -> Timed[tuple[str, str]]:
    rgb, depth = read_timed_files(folder / "rgb.txt"), read_timed_files(folder / "depth.txt")
    pairs = pair_by_time(rgb.stamps, depth.stamps, MAX_GAP_S)
    if not pairs:
        gap = smallest_gap(rgb.stamps, depth.stamps)
        raise InputError(
            f"{folder}: no colour and depth image are within {MAX_GAP_S:g} s of each other; "
            f"the smallest gap between rgb.txt and depth.txt is {gap:g} s"
        )
    warnings = rgb.warnings + depth.warnings
    alone = len(rgb.stamps) - len(pairs)
    if alone:
        warnings.append(
            f"rgb.txt: {alone} of {len(rgb.stamps)} images have no depth within {MAX_GAP_S:g} s, left out"
        )
    return Timed(
        [rgb.stamps[i] for i, _ in pairs],
        [(rgb.items[i], depth.items[j]) for i, j in pairs],
        rgb.skipped,
        warnings,
    )
