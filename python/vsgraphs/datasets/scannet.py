"""ScanNet (Dai et al., "ScanNet: Richly-annotated 3D Reconstructions of Indoor Scenes", CVPR 2017), exported.

Layout, as the data set's own SensReader writes it from a .sens file: `color/N.jpg`, `depth/N.png`
(millimetres), `pose/N.txt` (4x4 world_from_camera, -inf where the camera was lost),
`intrinsic/intrinsic_color.txt` and `intrinsic/intrinsic_depth.txt` (4x4). Colour is larger than depth
(1296x968 to 640x480) and has a camera of its own at the same place: it is sampled at the depth image's pixels
here, so both share the depth camera.
There are no timestamps: frame number / 30.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from vsgraphs.datasets.calibration import Calibration, check_calibration
from vsgraphs.datasets.cameras import choose_camera
from vsgraphs.datasets.numbered import pair_by_number
from vsgraphs.datasets.sequence import ColourGrid, FrameRef, RecordedSequence
from vsgraphs.errors import FrameError, InputError
from vsgraphs.trajectory import Array, Trajectory, read_number_rows, trajectory_from_matrices

NAME = "ScanNet"
LOOKED_FOR = "color/, depth/, pose/ and intrinsic/"
FRAMES_PER_S = 30.0


def detect(folder: Path) -> bool:
    """Whether the folder looks like this format."""
    images = all((folder / name).is_dir() for name in ("color", "depth"))
    return images and any((folder / name).is_dir() for name in ("pose", "intrinsic"))


def open_folder(folder: Path, camera: str | Path | Calibration | None = None) -> RecordedSequence:
    """Opens the sequence; raises InputError when nothing in it can be used."""
    numbered, warnings = pair_by_number(folder / "color", folder / "depth")
    sizes = (_size([colour for _, colour, _ in numbered]), _size([depth for *_, depth in numbered]))
    calibration, remarks = choose_camera(folder, camera, lambda: _depth_camera(folder, sizes[1]))
    grid = None
    if sizes[0] != (calibration.width, calibration.height):
        grid = _colour_grid(folder, sizes[0], calibration, needed=not isinstance(camera, Calibration))
    size = (calibration.width, calibration.height)
    frames = [
        FrameRef(number / FRAMES_PER_S, colour, depth, size, grid) for number, colour, depth in numbered
    ]
    poses = folder / "pose"
    found = {number: path for number, *_ in numbered if (path := poses / f"{number}.txt").is_file()}
    if not found:
        warnings.append(f"pose/: no pose of any frame, no ground truth ({poses}/N.txt)")
    elif len(found) < len(numbered):
        warnings.append(f"pose/: {len(numbered) - len(found)} of {len(numbered)} frames have no pose file")
    return RecordedSequence(
        folder,
        NAME,
        calibration,
        frames,
        (lambda: read_poses(found, folder)) if found else None,
        {},
        remarks + warnings,
    )


def read_poses(files: dict[int, Path], folder: Path) -> Trajectory:
    """Frame number -> pose file, as a trajectory in seconds; lost poses (-inf) are left out and told."""
    poses = np.array([_matrix(path, "a pose") for path in files.values()])
    stamps = np.array(list(files)) / FRAMES_PER_S
    truth = trajectory_from_matrices(stamps, poses, f"{folder.name}/pose")
    if not len(truth):
        raise InputError(f"{folder / 'pose'}: none of the {len(files)} poses is a finite rigid transform")
    return truth


def _matrix(path: Path, what: str) -> Array:
    rows = read_number_rows(path, 4, f"a row of {what} (4x4 matrix)")
    if rows.shape != (4, 4):
        raise InputError(f"{path}: {len(rows)} rows, expected {what} as a 4x4 matrix")
    return rows


def _intrinsics(folder: Path, image: str) -> tuple[float, float, float, float]:
    """fx, fy, cx, cy of the colour or depth camera."""
    path = folder / "intrinsic" / f"intrinsic_{image}.txt"
    if not path.is_file():
        raise InputError(
            f"{path} is missing; export it with SensReader's --export_intrinsics, or give --camera FILE"
        )
    k = _matrix(path, "a camera")
    if not np.isfinite(k).all() or not (k[0, 0] > 0 and k[1, 1] > 0):
        raise InputError(f"{path}: fx, fy = {k[0, 0]:g}, {k[1, 1]:g} must be positive, all numbers finite")
    return float(k[0, 0]), float(k[1, 1]), float(k[0, 2]), float(k[1, 2])


def _depth_camera(folder: Path, size: tuple[int, int]) -> Calibration:
    camera = Calibration(
        *size, *_intrinsics(folder, "depth"), depth_scale=1000.0, origin="intrinsic/intrinsic_depth.txt"
    )
    check_calibration(camera, str(folder / camera.origin))
    return camera


def _colour_grid(
    folder: Path, size: tuple[int, int], depth: Calibration, *, needed: bool
) -> ColourGrid | None:
    """Where in the colour image the depth camera's pixels look; None: not known, and not `needed`."""
    try:
        fx, fy, cx, cy = _intrinsics(folder, "color")
    except InputError:
        if needed:
            raise
        return None
    scale = (fx / depth.fx, fy / depth.fy)
    return ColourGrid(size, scale, (cx - scale[0] * depth.cx, cy - scale[1] * depth.cy))


def _size(images: list[Path]) -> tuple[int, int]:
    """(width, height) of the first readable image."""
    from vsgraphs.datasets.decode import image_size

    first = None
    for path in images:
        try:
            return image_size(path)
        except FrameError as error:
            first = first or error
    raise InputError(f"none of the {len(images)} images can be read; the first: {first}")
