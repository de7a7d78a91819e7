"""Trajectories: timed camera poses, and the TUM text format they are stored in.

TUM format: one pose per line, ``timestamp tx ty tz qx qy qz qw``; seconds, metres, world_from_camera, the
camera's optical axes (x right, y down, z forward). Lines starting with ``#`` are comments.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

from vsgraphs.errors import InputError
from vsgraphs.reading import LARGE, read_text, shown

Array = npt.NDArray[np.float64]

FARTHEST = 1e9  # metres from the origin; what is farther is no pose, and its square no number
_HEADER = "# timestamp tx ty tz qx qy qz qw (world_from_camera; seconds, metres)\n"


@dataclass
class Trajectory:
    """Poses in ascending, strictly increasing time.

    timestamps: (N,) seconds. poses: (N, 4, 4) world_from_camera, metres. notes: what reading had to repair.
    """

    timestamps: Array
    poses: Array
    notes: list[str] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.timestamps)

    @property
    def positions(self) -> Array:
        """(N, 3) camera centres in the world, metres."""
        positions: Array = self.poses[:, :3, 3]
        return positions


def rotations_from_quaternions(xyzw: Array) -> Array:
    """(N, 4) quaternions x y z w, any non-zero norm -> (N, 3, 3) rotations."""
    x, y, z, w = (xyzw / np.linalg.norm(xyzw, axis=1, keepdims=True)).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def quaternions_from_rotations(rotations: Array) -> Array:
    """(N, 3, 3) rotations -> (N, 4) unit quaternions x y z w with w >= 0.

    Of the four closed forms the one with the largest divisor is taken for each rotation (Shepperd, 1978).
    """
    r = rotations
    t = np.trace(r, axis1=1, axis2=2)
    d0, d1, d2 = r[:, 0, 0], r[:, 1, 1], r[:, 2, 2]
    sxy, sxz, syz = r[:, 0, 1] + r[:, 1, 0], r[:, 0, 2] + r[:, 2, 0], r[:, 1, 2] + r[:, 2, 1]
    ax, ay, az = r[:, 2, 1] - r[:, 1, 2], r[:, 0, 2] - r[:, 2, 0], r[:, 1, 0] - r[:, 0, 1]
    forms = np.array(
        [
            [1 + 2 * d0 - t, sxy, sxz, ax],
            [sxy, 1 + 2 * d1 - t, syz, ay],
            [sxz, syz, 1 + 2 * d2 - t, az],
            [ax, ay, az, 1 + t],
        ]
    )
    best = np.argmax(np.array([d0, d1, d2, t]), axis=0)
    q = forms[best, :, np.arange(len(r))]
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    q[q[:, 3] < 0] *= -1
    return q


def trajectory_from_rows(rows: Array, source: str) -> Trajectory:
    """(N, 8) TUM rows -> trajectory.

    Rows with NaN, a zero quaternion or numbers beyond `FARTHEST` go, disorder is sorted, of equal stamps the
    first stays; each repair is told in `notes`.
    """
    notes: list[str] = []
    near = (np.abs(rows[:, 1:8]) <= FARTHEST).all(axis=1) & np.isfinite(rows[:, 0])  # false for NaN
    length = np.linalg.norm(np.where(near[:, None], rows[:, 4:8], 0.0), axis=1)
    sound = near & (length > 1 / FARTHEST)
    if not sound.all():
        notes.append(f"{source}: {np.count_nonzero(~sound)} of {len(rows)} poses are not finite, skipped")
        rows = rows[sound]
    if len(rows) and (np.diff(rows[:, 0]) < 0).any():
        notes.append(f"{source}: poses are not in order of time, sorted")
        rows = rows[np.argsort(rows[:, 0], kind="stable")]
    repeated = np.concatenate([[False], np.diff(rows[:, 0]) == 0]) if len(rows) else np.zeros(0, bool)
    if repeated.any():
        notes.append(
            f"{source}: {np.count_nonzero(repeated)} repeated timestamps, the first pose of each kept"
        )
        rows = rows[~repeated]
    poses = np.tile(np.eye(4), (len(rows), 1, 1))
    if len(rows):
        poses[:, :3, :3] = rotations_from_quaternions(rows[:, 4:8])
        poses[:, :3, 3] = rows[:, 1:4]
    return Trajectory(rows[:, 0].copy(), poses, notes)


def trajectory_from_matrices(timestamps: Array, poses: Array, source: str) -> Trajectory:
    """Poses as (N, 4, 4) matrices; ones that are not rigid transforms (lost tracking in the truth) go."""
    rotations = poses[:, :3, :3]
    with np.errstate(all="ignore"):
        gram = rotations @ np.swapaxes(rotations, 1, 2)
        rigid = np.isfinite(poses).all(axis=(1, 2)) & (np.abs(gram - np.eye(3)).max(axis=(1, 2)) < 1e-2)
        rigid &= (np.abs(poses) <= FARTHEST).all(axis=(1, 2))
    rigid &= np.isfinite(timestamps)
    notes = []
    if not rigid.all():
        notes.append(f"{source}: {np.count_nonzero(~rigid)} of {len(poses)} poses are not rigid, skipped")
    return Trajectory(timestamps[rigid].copy(), poses[rigid].copy(), notes)


def read_number_rows(path: Path, columns: int, what: str) -> Array:
    """Text file of rows of numbers, blanks or commas between them -> (N, columns)."""
    text = read_text(path, "trajectory", LARGE, damaged=True)
    rows: list[list[float]] = []
    for number, line in enumerate(text.splitlines(), 1):
        fields = line.split("#", 1)[0].replace(",", " ").split()
        if not fields:
            continue
        if len(fields) < columns:
            raise InputError(f"{path}:{number}: {len(fields)} numbers where {what} has {columns}")
        try:
            rows.append([float(value) for value in fields[:columns]])
        except ValueError:
            raise InputError(f"{path}:{number}: not a number in {shown(line.strip())}") from None
    if not rows:
        raise InputError(f"{path} holds no pose; expected lines of {columns} numbers ({what})")
    return np.array(rows, dtype=np.float64)


def read_tum_trajectory(path: Path) -> Trajectory:
    """Reads a TUM trajectory file."""
    rows = read_number_rows(path, 8, "a TUM pose (timestamp tx ty tz qx qy qz qw)")
    trajectory = trajectory_from_rows(rows, path.name)
    if not len(trajectory):
        raise InputError(f"{path} holds no finite pose")
    return trajectory


def format_tum(timestamps: Iterable[float], poses: Array) -> str:
    """TUM text of poses (N, 4, 4): 1 us, 0.1 um and 1e-9 in the quaternion; equal input gives equal bytes."""
    lines = [_HEADER]
    quaternions = quaternions_from_rotations(poses[:, :3, :3]) if len(poses) else np.zeros((0, 4))
    for stamp, pose, q in zip(timestamps, poses, quaternions, strict=True):
        numbers = [_no_minus_zero(v, 7) for v in pose[:3, 3]] + [_no_minus_zero(v, 9) for v in q]
        lines.append(f"{stamp:.6f} {' '.join(numbers)}\n")
    return "".join(lines)


def _no_minus_zero(value: float, digits: int) -> str:
    rounded = round(float(value), digits)
    if not math.isfinite(rounded):
        return "nan"
    return f"{rounded + 0.0:.{digits}f}"
