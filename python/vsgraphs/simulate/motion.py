"""What an inertial unit and the wheels below the camera would have measured on the walk.

The unit sits in the camera and has its axes. Its errors are those of an ordinary one (ADIS16448):
white noise and biases that wander; the model of Nikolic, "Characterisation, calibration, and design of
visual-inertial sensors" (ETH Zurich, 2016). Wheels: errors that grow with the way (Thrun, Burgard and Fox,
"Probabilistic Robotics", 2005, ch. 5.4).
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from vsgraphs.simulate.stream import TIMESTAMP_OFFSET_S

Array = npt.NDArray[np.float64]
GRAVITY = 9.81


@dataclass(frozen=True)
class Errors:
    """Densities per root hertz, wander per root second; shares of the way."""

    gyro_noise: float = 1.7e-4  # rad/s/sqrt(Hz)
    gyro_wander: float = 2.0e-5  # rad/s^2/sqrt(Hz)
    gyro_bias: float = 3e-3  # rad/s, at the start
    accel_noise: float = 2.0e-3  # m/s^2/sqrt(Hz)
    accel_wander: float = 3.0e-3  # m/s^3/sqrt(Hz)
    accel_bias: float = 0.05  # m/s^2, at the start
    wheel_share: float = 0.02  # of the way
    wheel_turn_share: float = 0.02  # of the angle
    wheel_turn_rad_m: float = 0.01  # angle, for each metre driven
    imu_hz: float = 200.0
    wheels_hz: float = 50.0


def inertial(scene: Any, duration_s: float, errors: Errors, seed: int) -> tuple[Array, Array]:
    """Times (n,), s, and (n, 6): turn rates, rad/s, and specific force, m/s^2, in the camera's axes."""
    times = np.arange(0.0, duration_s, 1 / errors.imu_hz)
    # As a unit does, readings take in what happens between two of them: steps of a walk are short jerks.
    step = 1 / errors.imu_hz
    before, now, after = (scene.poses(times + shift) for shift in (-step, 0.0, step))
    earlier, later = (scene.poses(times + shift)[:, :3, :3] for shift in (-step / 2, step / 2))
    r = now[:, :3, :3]
    rates = rotation_vectors(np.einsum("nji,njk->nik", earlier, later)) / step
    acceleration = (after[:, :3, 3] - 2 * now[:, :3, 3] + before[:, :3, 3]) / step**2
    force = np.einsum("nji,nj->ni", r, acceleration + np.array([0.0, 0.0, GRAVITY]))
    exact = np.hstack([rates, force])
    return times, exact + _errors(len(times), errors, np.random.default_rng([seed, 1]))


def _errors(count: int, errors: Errors, draw: np.random.Generator) -> Array:
    scale = np.sqrt(errors.imu_hz)
    out = np.empty((count, 6))
    for begin, noise, wander, bias in (
        (0, errors.gyro_noise, errors.gyro_wander, errors.gyro_bias),
        (3, errors.accel_noise, errors.accel_wander, errors.accel_bias),
    ):
        steps = draw.normal(0, wander / scale, (count, 3))
        start = draw.normal(0, bias, 3) if bias else np.zeros(3)
        out[:, begin : begin + 3] = (
            start + np.cumsum(steps, axis=0) + draw.normal(0, noise * scale, (count, 3))
        )
    return out


def wheels(scene: Any, duration_s: float, errors: Errors, seed: int) -> tuple[Array, Array]:
    """Times (n,) and (n, 3): x, y, heading of the base below the camera, as its wheels count from 0."""
    times = np.arange(0.0, duration_s, 1 / errors.wheels_hz)
    poses = scene.poses(times)
    heading = np.unwrap(np.arctan2(poses[:, 1, 2], poses[:, 0, 2]))
    steps, turns = np.diff(poses[:, :2, 3], axis=0), np.diff(heading)
    draw = np.random.default_rng([seed, 2])
    way = np.linalg.norm(steps, axis=1)
    # Errors of single steps add up like noise: the stated share after a metre.
    root = np.sqrt(np.maximum(way, 0))
    counted = way + draw.normal(0, 1, len(way)) * errors.wheel_share * root
    turned = turns + draw.normal(0, 1, len(way)) * (
        errors.wheel_turn_share * np.sqrt(np.abs(turns)) + errors.wheel_turn_rad_m * root
    )
    relative = np.arctan2(steps[:, 1], steps[:, 0]) - heading[:-1]  # the base may go sideways
    angles = np.concatenate([[0.0], np.cumsum(turned)])
    towards = angles[:-1] + relative
    moved = np.where(way > 0, counted, 0.0)[:, None] * np.stack([np.cos(towards), np.sin(towards)], axis=1)
    places = np.vstack([np.zeros(2), np.cumsum(moved, axis=0)])
    return times, np.hstack([places, angles[:, None]])


def rotation_vectors(rotations: Array) -> Array:
    """(n, 3, 3) -> (n, 3), for angles well below a half turn."""
    off = np.stack(
        [
            rotations[:, 2, 1] - rotations[:, 1, 2],
            rotations[:, 0, 2] - rotations[:, 2, 0],
            rotations[:, 1, 0] - rotations[:, 0, 1],
        ],
        axis=1,
    )
    sine = np.linalg.norm(off, axis=1) / 2
    angle = np.arcsin(np.minimum(sine, 1.0))
    return off / 2 * np.where(sine > 1e-12, angle / np.maximum(sine, 1e-12), 1.0)[:, None]


def write_motion(scene: Any, folder: Path, until_s: float, seed: int) -> None:
    """imu.txt, imu.yaml and odometry.txt, from the start to `until_s`."""
    errors = Errors()
    times, readings = inertial(scene, until_s, errors, seed)
    _table(
        folder / "imu.txt", "wx wy wz (rad/s)  ax ay az (m/s^2, specific force), camera axes", times, readings
    )
    times, places = wheels(scene, until_s, errors, seed)
    _table(folder / "odometry.txt", "x y (m)  heading (rad) of the base, as its wheels count", times, places)
    values = [f"{name}: {getattr(errors, name):g}" for name in Errors.__dataclass_fields__]
    lines = [
        "# axes are the camera's; gravity 9.81 m/s^2 along the world's -z",
        "imu_from_camera: identity",
        *values,
    ]
    (folder / "imu.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")


def _table(path: Path, columns: str, times: Array, rows: Array) -> None:
    lines = [f"# timestamp {columns}"]
    lines += [
        f"{TIMESTAMP_OFFSET_S + time:.6f} " + " ".join(f"{value:.9f}" for value in row)
        for time, row in zip(times.tolist(), rows.tolist(), strict=True)
    ]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
